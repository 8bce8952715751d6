#include "twin/diagnose/screen/significance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace twinbench::diagnose::screen {
namespace {

/// (value - null mean) / null standard deviation; an item that does not vary becomes 0.
Eigen::MatrixXd Standardised(const Eigen::MatrixXd& values) {
  const Eigen::Index nulls = values.cols() - 1;
  const Eigen::VectorXd mean = values.rightCols(nulls).rowwise().mean();
  Eigen::MatrixXd scores = values.colwise() - mean;
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    const double sd = scores.row(i).tail(nulls).norm() / std::sqrt(static_cast<double>(nulls));
    scores.row(i) *= sd > 1e-9 * std::abs(mean[i]) && sd > 0.0 ? 1.0 / sd : 0.0;
  }
  return scores;
}

std::vector<std::string> LinesOf(const Statistic& statistic) {
  constexpr std::size_t kLines = 8;
  const auto score = [&](int item) { return statistic.values(item, 0); };
  std::vector<int> order(statistic.items.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, std::greater<>(), score);
  std::vector<std::string> lines;
  for (const int i : order) {
    if (lines.size() == kLines || !std::isfinite(score(i))) break;
    lines.push_back(fmt::format("{}: score {:.1f}", statistic.items[i], score(i)));
  }
  return lines;
}

}  // namespace

double PValue(const Eigen::VectorXd& statistic) {
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

ScreenTest Tested(const std::string& name, const Eigen::VectorXd& statistic) {
  ScreenTest test;
  test.name = name;
  test.statistic = statistic[0];
  test.p = PValue(statistic);
  return test;
}

Loudest LoudestOf(const Statistic& statistic) {
  Loudest loudest{Tested(statistic.test, statistic.values.colwise().maxCoeff().transpose())};
  statistic.values.col(0).maxCoeff(&loudest.item);
  loudest.test.tables = LinesOf(statistic);
  return loudest;
}

void TestMoments(const Statistic& moments, Sides sides, const Meaning& meaning, Tests& tests) {
  Statistic scores{moments.test, moments.items, Standardised(moments.values)};
  if (!(scores.values.cwiseAbs().maxCoeff() > 0.0)) return;
  if (sides == Sides::kBoth) scores.values = scores.values.cwiseAbs();
  auto [test, item] = LoudestOf(scores);
  const auto value = moments.values.row(item);
  meaning(item, value[0] - value.tail(value.size() - 1).mean(), test);
  tests.push_back(std::move(test));
}

Eigen::MatrixXd Normals(Stream& stream, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXf normals(rows, columns);
  stream.FillNormals({normals.data(), static_cast<std::size_t>(normals.size())});
  return normals.cast<double>();
}

}  // namespace twinbench::diagnose::screen
