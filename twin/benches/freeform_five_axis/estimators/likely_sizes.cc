#include "twin/benches/freeform_five_axis/estimators/likely_sizes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/core/linear_algebra.h"

namespace twinbench::benches::freeform::estimators {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double kLeastSize = 1e-3, kMostSize = 1e5;  // in residuals: nothing, and what no belief holds
constexpr double kLeastTold = 1e-6, kDigits = 1e-13;  // parts

/// Believed values with sizes.
struct Believed {
  VectorXd values, told;  // told: which part of each the readings tell
  double residual2 = 0.0;
};

/// What the readings say of all terms, once for all sizes.
class Squares {
 public:
  Squares(const MatrixXd& free, const MatrixXd& believed, const VectorXd& shifts_um)
      : believed_(believed.cols()), dof_(static_cast<double>(free.rows() - free.cols())),
        squares_um2_(shifts_um.squaredNorm()) {
    MatrixXd all(free.rows(), free.cols() + believed_);
    all << free, believed;
    normal_ = all.transpose() * all;
    shown_ = all.transpose() * shifts_um;
  }

  Believed With(const VectorXd& sizes) const {
    MatrixXd normal = normal_;
    normal.diagonal().tail(believed_) += sizes.cwiseAbs2().cwiseInverse();
    const auto [values, inverse] = SolveNormal(normal, shown_);
    const VectorXd told = 1.0 - inverse.diagonal().tail(believed_).array() / sizes.array().square();
    const double left_um2 = squares_um2_ - 2.0 * shown_.dot(values) + values.dot(normal_ * values);
    return {values.tail(believed_), told, std::max(left_um2, kDigits * squares_um2_) / std::max(1.0, dof_ - told.sum())};
  }

  double LogLikelihood(const VectorXd& sizes) const {
    MatrixXd normal = normal_;
    normal.diagonal().tail(believed_) += sizes.cwiseAbs2().cwiseInverse();
    const double left_um2 = squares_um2_ - shown_.dot(SolvePositive(normal, shown_));
    const double volume = CholeskyFactorOf(normal).diagonal().array().log().sum() + sizes.array().log().sum();
    return -0.5 * dof_ * std::log(std::max(left_um2, kDigits * squares_um2_)) - volume;
  }

 private:
  Index believed_;
  double dof_, squares_um2_;
  MatrixXd normal_;
  VectorXd shown_;
};

}  // namespace

double LikelySize(const MatrixXd& free, const MatrixXd& believed, const VectorXd& shifts_um, double least_gain) {
  const double dof = static_cast<double>(free.rows() - free.cols());
  if (believed.cols() == 0 || dof < 1.0) return 0.0;
  const auto rest = [inverse = GeneralInverseOf(free), &free](const auto& of) {
    return (of - free * (inverse * of)).eval();
  };
  const MatrixXd own = rest(believed);
  const double squares_um2 = rest(shifts_um).squaredNorm();
  const auto [values, vectors] = EigenOfSymmetric(own.transpose() * own);
  const VectorXd strength = values.cwiseMax(0.0);
  const VectorXd shown2 = (vectors.transpose() * (own.transpose() * shifts_um)).cwiseAbs2();
  double best = 0.0, most = -0.5 * dof * std::log(squares_um2) + least_gain;
  for (double size = 1e-2; size < 1e4; size *= 1.25) {
    const VectorXd with = 1.0 + size * size * strength.array();
    const double left_um2 = squares_um2 - (size * size * shown2.array() / with.array()).sum();
    const double likelihood = -0.5 * (dof * std::log(std::max(left_um2, 1e-300)) + with.array().log().sum());
    if (likelihood <= most) continue;
    most = likelihood;
    best = size;
  }
  return best;
}

LikelySizesFound LikelySizes(const MatrixXd& free, const MatrixXd& believed, const std::vector<int>& groups, const VectorXd& least,
                     const VectorXd& shifts_um) {
  constexpr int kRounds = 40;
  const Squares squares(free, believed, shifts_um);
  VectorXd sizes = least.cwiseMax(1.0);
  for (int round = 0; round < kRounds && believed.cols() > 0; ++round) {
    const Believed found = squares.With(sizes);
    std::map<int, double> shown2, told;
    for (Index k = 0; k < sizes.size(); ++k) {
      const int group = groups[static_cast<std::size_t>(k)];
      shown2[group] += found.values[k] * found.values[k] / found.residual2;
      told[group] += found.told[k];
    }
    for (Index k = 0; k < sizes.size(); ++k) {
      const int group = groups[static_cast<std::size_t>(k)];
      const double own = std::sqrt(shown2[group] / std::max(told[group], kLeastTold));
      sizes[k] = std::max(least[k], std::clamp(own, kLeastSize, kMostSize));
    }
  }
  return {sizes, squares.LogLikelihood(sizes)};
}

}  // namespace twinbench::benches::freeform::estimators
