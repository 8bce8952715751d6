#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr double kLeastRedundancy = 0.05;
constexpr std::array<double, 8> kDof = {2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 30.0};

/// Counts of |w|, w = residual / sqrt(redundancy), in bins fine enough for a likelihood: one pass over the rows for
/// all degrees of freedom and scales. Larger ones are kept as they are.
struct Histogram {
  static constexpr double kBin = 0.04;
  static constexpr int kBins = 200;
  std::array<double, kBins> count{};
  std::vector<double> beyond;
  double total = 0.0, sum_squares = 0.0;

  void Add(double w) {
    const auto bin = static_cast<std::size_t>(w / kBin);
    if (bin < kBins)
      count[bin] += 1.0;
    else
      beyond.push_back(w);
    total += 1.0;
    sum_squares += w * w;
  }
  template <typename Function>
  double Sum(const Function& f) const {
    double sum = 0.0;
    for (std::size_t b = 0; b < kBins; ++b) {
      if (count[b] > 0.0) sum += count[b] * f((static_cast<double>(b) + 0.5) * kBin);
    }
    for (double w : beyond) sum += f(w);
    return sum;
  }
};

Histogram HistogramOf(const Sample& s, int column) {
  Histogram h;
  for (int k = 0; k < s.run.Rows(); ++k) {
    if (s.redundancy[k] > kLeastRedundancy) h.Add(std::abs(s.levelled(k, column)) / std::sqrt(s.redundancy[k]));
  }
  return h;
}

/// Log likelihood of Student's t with the scale that is most probable for these degrees of freedom (fixed-point
/// iteration of its likelihood equation; it converges slowest, by 3/4 a step, at two degrees of freedom).
double LogLikelihood(const Histogram& h, double dof) {
  double variance = h.sum_squares / h.total;
  for (int step = 0; step < 8; ++step) {
    variance = h.Sum([&](double w) { return (dof + 1.0) * w * w / (dof + w * w / variance); }) / h.total;
  }
  const double constant =
      std::lgamma(0.5 * (dof + 1.0)) - std::lgamma(0.5 * dof) - 0.5 * std::log(dof * std::numbers::pi * variance);
  return h.total * constant -
         0.5 * (dof + 1.0) * h.Sum([&](double w) { return std::log1p(w * w / (dof * variance)); });
}

/// Likelihood ratio of the best t to a Gaussian, and its degrees of freedom.
std::pair<double, double> BestDof(const Histogram& h) {
  const double variance = h.sum_squares / h.total;
  const double gauss = -0.5 * h.total * (std::log(2.0 * std::numbers::pi * variance) + 1.0);
  std::pair<double, double> best{-std::numeric_limits<double>::infinity(), 0.0};
  for (double dof : kDof) best = std::max(best, {LogLikelihood(h, dof) - gauss, dof});
  return best;
}

void TestStudent(const Sample& s, Tests& tests) {
  Eigen::VectorXd ratio(s.Columns());
  double dof = 0.0;
  for (int j = 0; j < s.Columns(); ++j) {
    const Histogram h = HistogramOf(s, j);
    if (h.total < 20.0 || !(h.sum_squares > 0.0)) return;
    const auto [log_ratio, best] = BestDof(h);
    ratio[j] = log_ratio;
    if (j == 0) dof = best;
  }
  ScreenTest test;
  test.name = "tails";
  test.statistic = ratio[0];
  test.p = PValue(ratio);
  test.reading = ratio[0] > 0.0 ? fmt::format(
                                      "tails like Student's t with {:.0f} degrees of freedom: spikes, air "
                                      "turbulence, bumps",
                                      dof)
                                : "tails no heavier than a Gaussian's";
  tests.push_back(std::move(test));
}

std::string RowWords(const Sample& s, int row, double w) {
  const Schedule& schedule = s.run.schedule;
  const auto i = static_cast<std::size_t>(s.run.ReadingOf(row));
  return fmt::format("reading {} (set-up {}, pass {}, position {}), {}: {:.1f} standard deviations",
                     schedule.reading[i], schedule.setup[i], schedule.pass[i], schedule.position[i],
                     s.run.channels[static_cast<std::size_t>(s.run.ChannelOf(row))], w);
}

/// Baarda's w-test of each row; the largest is the statistic.
void TestOutliers(const Sample& s, Tests& tests) {
  const Eigen::VectorXd weight =
      (s.redundancy.array() > kLeastRedundancy).select(s.redundancy.array().rsqrt(), 0.0);
  const Eigen::MatrixXd w = weight.asDiagonal() * s.levelled.cwiseAbs();
  if (weight.maxCoeff() == 0.0) return;
  Eigen::Index row = 0;
  ScreenTest test;
  test.name = "outliers";
  test.statistic = w.col(0).maxCoeff(&row);
  test.p = PValue(w.colwise().maxCoeff().transpose());
  SetEffect(s.run, s.run.ChannelOf(static_cast<int>(row)),
            s.residual.col(0).cwiseAbs()[row] * weight[row] * weight[row] * s.run.sigma[row], test);
  test.reading = "one reading stands apart: " + RowWords(s, static_cast<int>(row), test.statistic);
  std::vector<std::pair<double, int>> order;
  for (int k = 0; k < s.run.Rows(); ++k) order.emplace_back(-w(k, 0), k);
  std::partial_sort(order.begin(), order.begin() + std::min<std::ptrdiff_t>(5, s.run.Rows()), order.end());
  for (std::size_t i = 0; i < 5 && i < order.size(); ++i) {
    test.tables.push_back(RowWords(s, order[i].second, -order[i].first));
  }
  tests.push_back(std::move(test));
}

}  // namespace

Tests TestTails(const Sample& sample) {
  Tests tests;
  TestStudent(sample, tests);
  TestOutliers(sample, tests);
  return tests;
}

}  // namespace twinbench::diagnose::screen
