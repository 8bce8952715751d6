#include <fmt/format.h>

#include <cmath>

#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/textbook.h"

namespace twinbench::diagnose::screen {
namespace {

void TellShape(const Judged& judged, int channel, const Eigen::VectorXd& residual, ResidualTest& test) {
  const LinearRun& run = judged.run;
  const Schedule& s = run.schedule;
  const Eigen::VectorXd values = judged.Normalised(residual, channel);
  const Shape shape = ShapeOf(values);
  int farthest = 0;
  values.cwiseAbs().maxCoeff(&farthest);
  const int row = judged.rows[channel][farthest], i = run.ReadingOf(row);
  test.statistic = JarqueBera(shape, values.size());
  SetEffect(run, channel, std::abs(residual[row]) / judged.redundancy[row] * run.sigma[row], test);
  const double rms = values.norm() / std::sqrt(static_cast<double>(values.size()));
  test.reading = fmt::format(
      "residuals of {} have skewness {:.2f} and kurtosis {:.2f} (normal noise: 0 and 3): {}; farthest is reading "
      "{} (mounting {}, pass {}, "
      "position {}) by {:.1f} standard deviations",
      run.channels[channel], shape.skewness, shape.kurtosis,
      shape.kurtosis > 3.0 ? "outliers, spikes, air turbulence or bumps" : "two levels, a wave or coarse rounding",
      s.reading[i], s.setup[i], s.pass[i], s.position[i], rms > 0.0 ? std::abs(values[farthest]) / rms : 0.0);
}

}  // namespace

/// Jarque and Bera's test of each channel.
std::optional<Test> Normality(const Judged& judged) {
  const std::vector<int> channels = judged.Channels(20);
  if (channels.empty()) return std::nullopt;
  Test test{.name = "normality"};
  for (const int c : channels) test.items.push_back(judged.run.channels[c]);
  test.scores = [&judged, channels](const Eigen::MatrixXd& residual) {
    return ByColumn(residual, [&](const Eigen::VectorXd& of_run) {
      Eigen::VectorXd scores(std::ssize(channels));
      for (Eigen::Index k = 0; k < scores.size(); ++k) {
        const Eigen::VectorXd values = judged.Normalised(of_run, channels[k]);
        scores[k] = std::log(std::max(JarqueBera(ShapeOf(values), values.size()), 1e-300));
      }
      return scores;
    });
  };
  test.tell = [&judged, channels](int item, const Eigen::VectorXd& residual, ResidualTest& told) {
    TellShape(judged, channels[item], residual, told);
  };
  return test;
}

}  // namespace twinbench::diagnose::screen
