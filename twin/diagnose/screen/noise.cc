#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "twin/core/distributions.h"
#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"

/// Is what is left white noise of the stated size, without outliers?
namespace twinbench::diagnose::screen {
namespace {

double MeanSigma(const LinearRun& run) {
  return std::sqrt(run.sigma.squaredNorm() / run.Rows());
}

void TestStatedNoise(const Sample& s, Tests& tests) {
  const double dof = s.redundancy.sum();
  if (!s.run.sigma_stated || !(dof > 0.0)) return;
  // The logarithm: its nulls are nearly Gaussian, and a residual too small is as telling as one too large.
  const Statistic level{"fit to stated noise",
                        {ItemOf("fit to stated noise")},
                        (s.residual.colwise().squaredNorm() / dof).array().max(1e-300).log()};
  const auto meaning = [&](int, double, ScreenTest& test) {
    const double ratio = std::exp(0.5 * level.values(0, 0));
    SetEffect(s.run, AnyChannel(s.run), Excess(MeanSigma(s.run), ratio), test);
    test.reading = ReadingBySign(test.name, ratio > 1.0, ratio);
  };
  TestMoments(level, Sides::kBoth, meaning, tests);
}

/// Places and directions that were visited more than once; -1 elsewhere.
std::vector<int> Repeats(const Schedule& schedule) {
  std::vector<std::pair<PlaceKey, int>> keys;
  for (int i = 0; i < schedule.Readings(); ++i)
    keys.emplace_back(PlaceOfReading(schedule, i), schedule.direction[i]);
  std::vector<int> group = Numbered(keys), count(group.size(), 0);
  for (int g : group) ++count[g];
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (schedule.phase[i] == Phase::kCalibration || count[group[i]] < 2) group[i] = -1;
  }
  return group;
}

/// Lack of fit: what repeats have in common against what they do not. Knows no stated noise.
void TestRepeats(const Sample& s, Tests& tests) {
  const std::vector<int> group = Repeats(s.run.schedule);
  const Eigen::VectorXd count = SumsByGroup(Eigen::VectorXd::Ones(std::ssize(group)), group);
  Eigen::RowVectorXd between = Eigen::RowVectorXd::Zero(s.Columns()), all = between;  // sums of squares
  for (int c = 0; c < s.run.Channels(); ++c) {
    const Eigen::MatrixXd residual = s.residual(RowsOf(s.run, c), Eigen::all);
    between += count.cwiseMax(1.0).cwiseInverse().transpose() * SumsByGroup(residual, group).cwiseAbs2();
    for (Eigen::Index i = 0; i < residual.rows(); ++i) {
      if (group[i] >= 0) all += residual.row(i).cwiseAbs2();
    }
  }
  const Eigen::RowVectorXd within = all - between;
  if (!(within.minCoeff() > 0.0)) return;
  const Statistic repeated{
      "fit to repeats", {ItemOf("fit to repeats")}, (between.array().max(1e-300) / within.array()).log()};
  const auto meaning = [&](int, double excess, ScreenTest& test) {
    const double common = std::max(0.0, std::expm1(excess));
    SetEffect(s.run, AnyChannel(s.run), MeanSigma(s.run) * std::sqrt(common), test);
    test.reading = ReadingBySign(test.name, common > 0.0, 1.0 + common);
  };
  TestMoments(repeated, Sides::kUpper, meaning, tests);
}

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

void TestStudent(const Sample& s, const std::vector<int>& judged, Tests& tests) {
  Eigen::VectorXd log_ratio(s.Columns());
  double dof = 0.0;
  for (int j = s.Columns() - 1; j >= 0; --j) {  // the run last, so that its degrees of freedom stay
    Histogram h;
    for (int row : judged) h.Add(std::abs(s.levelled(row, j)) / std::sqrt(s.redundancy[row]));
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
void TestOutliers(const Sample& s, std::vector<int> judged, Tests& tests) {
  if (judged.empty()) return;
  const Eigen::VectorXd weight = s.redundancy(judged).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd w = weight.asDiagonal() * s.levelled(judged, Eigen::all).cwiseAbs();
  ScreenTest test = Tested("outliers", w.colwise().maxCoeff().transpose());
  std::vector<int> order(judged.size());
  std::iota(order.begin(), order.end(), 0);
  const auto lines = order.begin() + std::min<std::ptrdiff_t>(5, std::ssize(order));
  std::ranges::partial_sort(order, lines, {}, [&](int k) { return std::pair(-w(k, 0), k); });
  for (auto k = order.begin(); k != lines; ++k) test.tables.push_back(RowWords(s, judged[*k], w(*k, 0)));
  const int row = judged[order.front()];
  SetEffect(s.run, s.run.ChannelOf(row), std::abs(s.residual(row, 0)) / s.redundancy[row] * s.run.sigma[row], test);
  test.reading = ReadingOf(test.name, test.tables.front());
  tests.push_back(std::move(test));
}

/// Products of residuals `lag` readings apart in the same pass and channel, summed; one a column. Their expectation
/// is not zero: a projected white residual is negatively correlated. The nulls carry it.
Eigen::RowVectorXd LagProducts(const Sample& s, int lag, int& pairs) {
  const int channels = s.run.Channels();
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(s.Columns());
  for (int i = lag; i < s.run.schedule.Readings(); ++i) {
    if (!SamePass(s.run.schedule, i, i - lag)) continue;
    const auto before = s.levelled.middleRows((i - lag) * channels, channels);
    sum += s.levelled.middleRows(i * channels, channels).cwiseProduct(before).colwise().sum();
    pairs += channels;
  }
  return sum;
}

}  // namespace

void TestFit(const Sample& sample, Tests& tests) {
  TestStatedNoise(sample, tests);
  TestRepeats(sample, tests);
}

void TestTails(const Sample& sample, Tests& tests) {
  constexpr double kLeastRedundancy = 0.05;  // a row below says nothing about its own noise
  std::vector<int> judged;
  for (int row = 0; row < sample.run.Rows(); ++row) {
    if (sample.redundancy[row] > kLeastRedundancy) judged.push_back(row);
  }
  TestStudent(sample, judged, tests);
  TestOutliers(sample, judged, tests);
}

void TestWhiteness(const Sample& s, Tests& tests) {
  std::array<int, 5> pairs{};
  Statistic products{"whiteness within a pass", {}, Eigen::MatrixXd(pairs.size(), s.Columns())};
  for (int k = 0; k < std::ssize(pairs); ++k) {
    products.values.row(k) = LagProducts(s, k + 1, pairs[k]);
    products.items.push_back(ItemOf(products.test, k + 1));
  }
  const auto meaning = [&](int item, double excess, ScreenTest& test) {
    const double correlation = excess / (s.redundancy.mean() * pairs[item]);
    const double share = std::sqrt(std::min(1.0, std::abs(correlation)));
    SetEffect(s.run, AnyChannel(s.run), s.level.mean() * TypicalSigma(s.run, 0) * share, test);
    test.reading = ReadingBySign(test.name, correlation > 0.0, item + 1, correlation);
  };
  TestMoments(products, Sides::kBoth, meaning, tests);
}

}  // namespace twinbench::diagnose::screen
