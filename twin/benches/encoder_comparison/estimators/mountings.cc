#include "twin/benches/encoder_comparison/estimators/mountings.h"

#include <algorithm>
#include <cmath>

#include "twin/core/distributions.h"
#include "twin/separate/order_model.h"

namespace twinbench::separate::encoder {
namespace {

using harmonics::Coefficient;

constexpr double kFloor_rad = 1e-12;  // rounding: readings without noise have a weight
constexpr double kContradiction = 1e-3;

std::vector<int> DirectionsOf(const harmonics::Positions& seen) {
  std::vector<int> directions;
  for (const int d : {1, -1}) {
    if (std::ranges::any_of(seen, [d](const harmonics::PositionError* p) { return p->direction == d; }))
      directions.push_back(d);
  }
  return directions;
}

/// One order, solved: unknowns D of each direction, then - R.
struct SolvedOrder {
  Eigen::VectorXd x;
  Eigen::MatrixXd cov;

  /// Sum of weight x unknown over the first unknowns.
  Coefficient Sum(const std::vector<double>& weights) const {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(2, x.size());
    for (std::size_t i = 0; i < weights.size(); ++i)
      sum.middleCols<2>(2 * static_cast<Eigen::Index>(i)) = weights[i] * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d parts = sum * x;
    return {{parts[0], parts[1]}, sum * cov * sum.transpose()};
  }
};

class Separation {
 public:
  Separation(harmonics::Positions seen, double max_noise_factor, const Rounding& rounding)
      : seen_(std::move(seen)), directions_(DirectionsOf(seen_)), max_noise_factor_(max_noise_factor), rounding_(rounding) {}

  SeparatedCurves Run() {
    for (const harmonics::PositionError* position : seen_)
      highest_ = std::min(highest_, position->series.Highest());
    for (int order = 1; order <= highest_; ++order) Add(order);
    if (static_cast<int>(curves_.lost.size()) == highest_) curves_.reference = {};
    for (harmonics::HarmonicSeries* series :
         {&curves_.device, &curves_.forward, &curves_.backward, &curves_.reversal, &curves_.reference})
      series->dof = seen_.front()->series.dof;
    return curves_;
  }

 private:
  void Add(int order) {
    harmonics::OrderModel model =
        harmonics::ModelOrder(order, seen_, directions_, std::vector<double>(seen_.size(), kFloor_rad));
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const auto at = 2 * static_cast<Eigen::Index>(i);
      model.cov.block<2, 2>(at, at) += rounding_.Between(i, i, order);
    }
    const bool separated = harmonics::NoiseFactorOf(model.x) <= max_noise_factor_;
    const Eigen::MatrixXcd x = separated ? model.x : Eigen::MatrixXcd(model.x.leftCols(model.x.cols() - 1));
    const harmonics::OrderSolution solution = harmonics::SolveOrder(x, model);
    const Eigen::MatrixXd cov = Widening(order, solution) * model.cov + InCommon(order);
    const SolvedOrder solved{solution.x, solution.from_readings * cov * solution.from_readings.transpose()};
    if (!separated) curves_.lost.push_back(order);
    AddDevice(solved);
    std::vector<double> minus_last(directions_.size() + 1, 0.0);
    minus_last.back() = -1.0;
    curves_.reference.orders.push_back(separated ? solved.Sum(minus_last) : Coefficient{});
  }

  void AddDevice(const SolvedOrder& solved) {
    const bool both = directions_.size() == 2;
    curves_.device.orders.push_back(solved.Sum(both ? std::vector{0.5, 0.5} : std::vector{1.0}));
    if (both) curves_.reversal.orders.push_back(solved.Sum({1.0, -1.0}));
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      std::vector<double> one(directions_.size(), 0.0);
      one[d] = 1.0;
      (directions_[d] > 0 ? curves_.forward : curves_.backward).orders.push_back(solved.Sum(one));
    }
  }

  /// What is common to two positions counts in the result, not in the weights.
  Eigen::MatrixXd InCommon(int order) const {
    const auto rows = std::ssize(seen_);
    Eigen::MatrixXd common = Eigen::MatrixXd::Zero(2 * rows, 2 * rows);
    for (Eigen::Index a = 0; a < rows; ++a) {
      for (Eigen::Index b = 0; b < rows; ++b) {
        if (a != b) common.block<2, 2>(2 * a, 2 * b) = rounding_.Between(static_cast<std::size_t>(a), static_cast<std::size_t>(b), order);
      }
    }
    return common;
  }

  double Widening(int order, const harmonics::OrderSolution& solution) {
    if (order > 1 && solution.dof > 0 && std::isfinite(solution.chi2)) {
      curves_.chi2 += solution.chi2;
      curves_.dof += solution.dof;
    }
    if (solution.dof <= 0 || ChiSquaredExceedance(solution.chi2, solution.dof) > kContradiction / highest_)
      return 1.0;
    curves_.disagreeing.push_back(order);
    return solution.chi2 / solution.dof;
  }

  harmonics::Positions seen_;
  std::vector<int> directions_;
  double max_noise_factor_;
  const Rounding& rounding_;
  int highest_ = 1 << 20;
  SeparatedCurves curves_;
};

}  // namespace

SeparatedCurves SeparateMountings(const std::vector<harmonics::PositionError>& seen, double max_noise_factor,
                                  const Rounding& rounding) {
  harmonics::Positions pointers;
  for (const harmonics::PositionError& position : seen) pointers.push_back(&position);
  return Separation(pointers, max_noise_factor, rounding).Run();
}

}  // namespace twinbench::separate::encoder
