#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "twin/core/distributions.h"
#include "twin/diagnose/screen/sizes.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr double kLeastRedundancy = 0.05;

/// Counts of |w|, w = residual / sqrt(redundancy), in bins fine enough for a likelihood: one pass over the rows for
/// all degrees of freedom and scales. Larger ones are kept as they are.
struct Histogram {
  std::map<double, double> count;  // by |w|
  double total = 0.0, sum_squares = 0.0;

  void Add(double w) {
    constexpr double kBin = 0.04, kBinned = 8.0;
    count[w < kBinned ? (std::floor(w / kBin) + 0.5) * kBin : w] += 1.0;
    total += 1.0;
    sum_squares += w * w;
  }
  template <typename Function>
  double Sum(const Function& f) const {
    double sum = 0.0;
    for (const auto& [w, n] : count) sum += n * f(w);
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
  for (int step = 0; step < 8; ++step)
    variance = h.Sum([&](double w) { return (dof + 1.0) * w * w / (dof + w * w / variance); }) / h.total;
  const double scale = std::sqrt(variance);
  return h.Sum([&](double w) { return StudentLogDensity(w, dof, scale); });
}

/// Likelihood ratio of the best t to a Gaussian, and its degrees of freedom.
std::pair<double, double> BestDof(const Histogram& h) {
  const double scale = std::sqrt(h.sum_squares / h.total);
  const double gauss = h.total * NormalLogDensity(scale, scale);
  std::pair<double, double> best{-std::numeric_limits<double>::infinity(), 0.0};
  for (double dof : {2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 30.0})
    best = std::max(best, {LogLikelihood(h, dof) - gauss, dof});
  return best;
}

void TestStudent(const Sample& s, Tests& tests) {
  Eigen::VectorXd log_ratio(s.Columns());
  double dof = 0.0;
  for (int j = s.Columns() - 1; j >= 0; --j) {  // the run last, so that its degrees of freedom stay
    const Histogram h = HistogramOf(s, j);
    if (h.total < 20.0 || !(h.sum_squares > 0.0)) return;
    std::tie(log_ratio[j], dof) = BestDof(h);
  }
  ScreenTest test = Tested("tails", log_ratio);
  test.reading = ReadingBySign(test.name, test.statistic > 0.0, dof);
  tests.push_back(std::move(test));
}

std::string RowWords(const Sample& s, int row, double w) {
  const Schedule& schedule = s.run.schedule;
  const int i = s.run.ReadingOf(row);
  return ItemOf("outliers", schedule.reading[i], schedule.setup[i], schedule.pass[i], schedule.position[i],
                s.run.channels[s.run.ChannelOf(row)], w);
}

/// Baarda's w-test of each row; the largest is the statistic.
void TestOutliers(const Sample& s, Tests& tests) {
  constexpr int kLines = 5;
  const Eigen::VectorXd weight =
      (s.redundancy.array() > kLeastRedundancy).select(s.redundancy.array().rsqrt(), 0.0);
  if (weight.maxCoeff() == 0.0) return;
  const Eigen::MatrixXd w = weight.asDiagonal() * s.levelled.cwiseAbs();
  ScreenTest test = Tested("outliers", w.colwise().maxCoeff().transpose());
  std::vector<int> order(s.run.Rows());
  std::iota(order.begin(), order.end(), 0);
  const auto lines = order.begin() + std::min(kLines, s.run.Rows());
  std::ranges::partial_sort(order, lines, {}, [&](int row) { return std::pair(-w(row, 0), row); });
  for (auto row = order.begin(); row != lines; ++row) test.tables.push_back(RowWords(s, *row, w(*row, 0)));
  const int row = order.front();
  SetEffect(s.run, s.run.ChannelOf(row),
            std::abs(s.residual(row, 0)) * weight[row] * weight[row] * s.run.sigma[row], test);
  test.reading = ReadingOf(test.name, test.tables.front());
  tests.push_back(std::move(test));
}

}  // namespace

void TestTails(const Sample& sample, Tests& tests) {
  TestStudent(sample, tests);
  TestOutliers(sample, tests);
}

}  // namespace twinbench::diagnose::screen
