#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/textbook.h"

namespace twinbench::diagnose::screen {
namespace {

/// As many lags as tell most and are worth their number: a fifth of the readings, at most ten.
int LagsOf(const Eigen::VectorXd& series) {
  return static_cast<int>(std::clamp<Eigen::Index>(series.size() / 5, 1, 10));
}

void TellRuns(const Eigen::VectorXd& series, const std::string& channel, ResidualTest& test) {
  test.statistic = RunsScore(series);
  test.reading =
      fmt::format("runs of one sign on {} are {} than in noise, by {:.1f} standard deviations: {}", channel,
                  test.statistic < 0.0 ? "fewer and longer" : "more and shorter", std::abs(test.statistic),
                  test.statistic < 0.0 ? "something that lasts, as drift or backlash, is not modelled"
                                       : "an error that alternates from reading to reading");
}

void TellAutocorrelation(const Eigen::VectorXd& series, const std::string& channel, ResidualTest& test) {
  const Eigen::VectorXd correlation = Autocorrelation(series, LagsOf(series));
  int worst = 0;
  correlation.cwiseAbs().maxCoeff(&worst);
  test.statistic = LjungBox(correlation, series.size());
  test.reading = fmt::format(
      "readings of {} that are {} apart are correlated by {:+.3f}: {}", channel, worst + 1, correlation[worst],
      correlation[worst] > 0.0 ? "correlated noise, drift or slow dynamics that are not modelled"
                               : "an alternating error, or noise that a filter has differentiated");
}

}  // namespace

/// Of each channel in the order of its readings, whatever the pass.
std::optional<Test> RunsAndAutocorrelation(const Judged& judged) {
  const std::vector<int> channels = judged.Channels(8);
  if (channels.empty()) return std::nullopt;
  Test test{.name = "runs and autocorrelation", .is_two_sided = true};
  for (const int c : channels) {
    for (const char* of : {"runs of ", "autocorrelation of "}) test.items.push_back(of + judged.run.channels[c]);
  }
  test.scores = [&judged, channels](const Eigen::MatrixXd& residual) {
    return ByColumn(residual, [&](const Eigen::VectorXd& of_run) {
      std::vector<double> scores;
      for (const int c : channels) {
        const Eigen::VectorXd series = judged.Normalised(of_run, c);
        const int lags = LagsOf(series);
        scores.push_back(RunsScore(series));
        scores.push_back(NormalScore(LjungBox(Autocorrelation(series, lags), series.size()), lags));
      }
      return Eigen::VectorXd(Eigen::VectorXd::Map(scores.data(), std::ssize(scores)));
    });
  };
  test.tell = [&judged, channels](int item, const Eigen::VectorXd& residual, ResidualTest& told) {
    const int channel = channels[item / 2];
    (item % 2 == 0 ? TellRuns : TellAutocorrelation)(judged.Normalised(residual, channel),
                                                     judged.run.channels[channel], told);
  };
  return test;
}

}  // namespace twinbench::diagnose::screen
