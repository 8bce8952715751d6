#include "twin/diagnose/screen/screen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "twin/core/errors.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"
#include "twin/diagnose/screen/tests.h"

namespace twinbench::diagnose {
namespace {

using screen::Judged, screen::Test;

Eigen::MatrixXd Normals(Stream& stream, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXf normals(rows, columns);
  stream.FillNormals({normals.data(), static_cast<std::size_t>(normals.size())});
  return normals.cast<double>();
}

/// Prior deviations of the free unknowns, no wider than kWide times what the rows alone could tell: the projection
/// removes them, and wide draws would only cost digits.
Eigen::VectorXd UsefulPriors(const Projector& projector, const Nuisance& nuisance) {
  constexpr double kWide = 1e4;
  const auto& jacobian = projector.Jacobian();
  const Eigen::ArrayXd norm =
      (jacobian.cwiseAbs2().transpose() * Eigen::VectorXd::Ones(jacobian.rows())).array().sqrt();
  return (norm > 0.0).select(nuisance.prior_precision.array().rsqrt().min(kWide / norm), 0.0);
}

/// Scores of the run, column 0, and of nulls, of which few at a time are in memory: white noise, and unknowns drawn
/// from their priors, for a calibrated gain is never exactly its prior mean.
std::vector<Eigen::MatrixXd> ScoresOf(const Judged& judged, const std::vector<Test>& tests, int null_runs,
                                      std::uint64_t seed) {
  constexpr int kAtATime = 50;
  const Nuisance& nuisance = judged.run.nuisance;
  const Eigen::VectorXd priors = UsefulPriors(judged.projector, nuisance);
  Stream of_unknowns(seed, "screen.null.unknowns"), of_noise(seed, "screen.null.noise");
  std::vector<Eigen::MatrixXd> scores(tests.size());
  for (int from = 0; from <= null_runs; from += kAtATime) {
    const int count = std::min(kAtATime, null_runs + 1 - from);
    Eigen::MatrixXd white = Normals(of_noise, judged.run.Rows(), count);
    white += judged.projector.Jacobian() * (priors.asDiagonal() * Normals(of_unknowns, priors.size(), count));
    if (from == 0) white.col(0) = judged.noise.Whiten(judged.run, Eigen::MatrixXd(judged.run.residual));
    const Eigen::MatrixXd residual = judged.projector.Apply(white);
    for (std::size_t k = 0; k < tests.size(); ++k) {
      const Eigen::MatrixXd some = tests[k].scores(residual);
      if (from == 0) scores[k].resize(some.rows(), null_runs + 1);
      scores[k].middleCols(from, count) = some;
    }
  }
  return scores;
}

/// (score - null mean) / null standard deviation. An item that does not vary says nothing: -infinity.
Eigen::MatrixXd Standardised(const Eigen::MatrixXd& scores, bool is_two_sided) {
  const Eigen::Index nulls = scores.cols() - 1;
  const Eigen::VectorXd mean = scores.rightCols(nulls).rowwise().mean();
  Eigen::MatrixXd standard = scores.colwise() - mean;
  if (is_two_sided) standard = standard.cwiseAbs();
  for (Eigen::Index i = 0; i < scores.rows(); ++i) {
    const double sd =
        (scores.row(i).tail(nulls).array() - mean[i]).matrix().norm() / std::sqrt(static_cast<double>(nulls));
    if (sd > 1e-9 * std::abs(mean[i]))
      standard.row(i) /= sd;
    else
      standard.row(i).setConstant(-std::numeric_limits<double>::infinity());
  }
  return standard;
}

std::vector<std::string> LinesOf(const std::vector<std::string>& items, const Eigen::VectorXd& score) {
  constexpr std::size_t kLines = 8;
  std::vector<int> order(items.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater<>(), [&](int item) { return score[item]; });
  std::vector<std::string> lines;
  for (const int item : order) {
    if (lines.size() < kLines && std::isfinite(score[item]))
      lines.push_back(fmt::format("{}: score {:.1f}", items[item], score[item]));
  }
  return lines;
}

/// "0.31 um (0.32 arcsec)", whichever there is; empty if a size has no meaning.
std::string SizeInWords(const ResidualTest& test) {
  const std::string length = fmt::format("{:.3g} um", test.effect_m / units::um);
  const std::string angle = fmt::format("{:.3g} arcsec", test.effect_rad / units::arcsec);
  if (!std::isfinite(test.effect_rad)) return std::isfinite(test.effect_m) ? length : "";
  return std::isfinite(test.effect_m) ? fmt::format("{} ({})", length, angle) : angle;
}

ResidualTest Told(const Test& test, const Eigen::MatrixXd& standard, const Eigen::VectorXd& residual) {
  constexpr double kSeldom = 0.05;
  ResidualTest told;
  told.name = test.name;
  told.p = screen::PValue(standard.colwise().maxCoeff().transpose());
  told.tables = LinesOf(test.items, standard.col(0));
  int worst = 0;
  standard.col(0).maxCoeff(&worst);
  test.tell(worst, residual, told);
  if (const std::string size = SizeInWords(told); !size.empty()) told.reading += "; size " + size;
  if (told.p > kSeldom) told.reading = "not beyond noise; largest: " + told.reading;
  return told;
}

std::vector<Test> TestsOf(const Judged& judged) {
  std::vector<Test> tests;
  for (const auto make : {screen::FitToStatedNoise, screen::RunsAndAutocorrelation, screen::Periodogram,
                          screen::Normality, screen::VarianceByGroup}) {
    if (auto test = make(judged)) tests.push_back(std::move(*test));
  }
  return tests;
}

std::string InWords(const std::vector<ResidualTest>& tests) {
  std::string text;
  for (const ResidualTest& test : tests)
    text += fmt::format("{}({}) {}", text.empty() ? "" : "; ", test.name, test.reading);
  return text;
}

}  // namespace

double screen::PValue(const Eigen::VectorXd& statistic) {
  const auto nulls = static_cast<int>(statistic.size()) - 1;
  std::vector<double> sorted(statistic.data() + 1, statistic.data() + statistic.size());
  std::ranges::sort(sorted, std::greater<>());
  const int tail = std::max(10, nulls / 10);
  const double threshold = sorted[tail];
  if (!(statistic[0] > threshold)) {
    const auto above = std::ranges::count_if(sorted, [&](double v) { return v >= statistic[0]; });
    return (static_cast<double>(above) + 1.0) / (nulls + 1.0);
  }
  double excess = 0.0;
  for (int i = 0; i < tail; ++i) excess += (sorted[i] - threshold) / tail;
  const double share = (tail + 1.0) / (nulls + 1.0) * std::exp(-(statistic[0] - threshold) / excess);
  return std::max(share, std::numeric_limits<double>::min());
}

std::vector<ResidualTest> TestResiduals(const LinearRun& run, const NoiseModel& noise, int null_runs,
                                        std::uint64_t seed) {
  if (run.noise_free) return {};  // the last digits of formulas are no noise
  if (null_runs == 0) null_runs = std::clamp(2000000 / std::max(run.Rows(), 1), 150, 300);
  Require(null_runs >= 50, "residual tests need at least 50 simulated runs");
  Require(run.Rows() == run.schedule.Readings() * run.Channels(), "a run has one row a reading and channel");
  const Projector projector(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  const Judged judged = screen::Judge(run, noise, projector);
  const std::vector<Test> tests = TestsOf(judged);
  const std::vector<Eigen::MatrixXd> scores = ScoresOf(judged, tests, null_runs, seed);
  const Eigen::VectorXd residual = projector.Apply(noise.Whiten(run, Eigen::MatrixXd(run.residual)));
  std::vector<ResidualTest> told;
  for (std::size_t k = 0; k < tests.size(); ++k) {
    const Eigen::MatrixXd standard = Standardised(scores[k], tests[k].is_two_sided);
    if (std::isfinite(standard.col(0).maxCoeff())) told.push_back(Told(tests[k], standard, residual));
  }
  return told;
}

std::vector<ResidualTest> StandingOut(std::vector<ResidualTest> tests) {
  const double threshold = kResidualFalseAlarms / static_cast<double>(std::max<std::size_t>(1, tests.size()));
  std::erase_if(tests, [=](const ResidualTest& test) { return !(test.p < threshold); });
  std::ranges::stable_sort(tests, {}, &ResidualTest::p);
  return tests;
}

std::string ResidualTestsInWords(const std::vector<ResidualTest>& tests) {
  const std::vector<ResidualTest> out = StandingOut(tests);
  const std::string told =
      out.empty() ? fmt::format("none of {} shows what noise alone would give in fewer than", tests.size())
                  : fmt::format("{} of {} {} what noise alone would give in fewer than", out.size(), tests.size(),
                                out.size() == 1 ? "shows" : "show");
  return fmt::format("Residual tests of the scenario as it was believed: {} {:.0f} run in 100.{}", told,
                     100.0 * kResidualFalseAlarms, out.empty() ? "" : " " + InWords(out) + ".");
}

}  // namespace twinbench::diagnose
