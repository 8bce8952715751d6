#include "twin/benches/encoder_comparison/diagnosis/target_curve.h"

#include <algorithm>
#include <vector>

#include "twin/core/linear_algebra.h"
#include "twin/core/robust_scale.h"
#include "twin/core/units.h"
#include "twin/diagnose/unknown/collector.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::encoder {
namespace {

/// cos(k pi (angle - begin) / travel), k = 0, 1, ...; the ends lie half a step beyond the outer targets.
struct HalfPeriods {
  double begin_rad, per_rad;  // of k

  Eigen::MatrixXd At(const Eigen::VectorXd& angle_rad, Eigen::Index count) const {
    Eigen::MatrixXd modes(angle_rad.size(), count);
    for (Eigen::Index k = 0; k < count; ++k)
      modes.col(k) = (static_cast<double>(k) * per_rad * (angle_rad.array() - begin_rad)).cos();
    return modes;
  }
};

HalfPeriods Between(const Eigen::VectorXd& target_rad) {
  const double range_rad = target_rad.maxCoeff() - target_rad.minCoeff();
  const double half_step_rad = 0.5 * range_rad / static_cast<double>(target_rad.size() - 1);
  return {target_rad.minCoeff() - half_step_rad, units::kPi / (range_rad + 2.0 * half_step_rad)};
}

/// The constant is that of the mounting.
std::vector<Product> ProductsOf(const HalfPeriods& modes, const Eigen::VectorXd& sizes_rad) {
  std::vector<Product> products;
  for (Eigen::Index k = 1; k < sizes_rad.size(); ++k) {
    const double order = static_cast<double>(k) * modes.per_rad;
    const double phase_rad = std::remainder(-order * modes.begin_rad, units::turn);
    products.push_back({unknown::SignalOf("harmonic", "device", {{"order", order}, {"phase", phase_rad}}), 0, false,
                        sizes_rad[k]});
  }
  return products;
}

/// How far values are off the sum of columns that most of them lie on: Tukey's weights.
Eigen::VectorXd OffMostOf(const Eigen::MatrixXd& columns, const Eigen::VectorXd& values) {
  constexpr int kRounds = 20;
  constexpr double kTukey = 4.685;  // deviations of the middle half; 95 % as sharp as least squares
  Eigen::ArrayXd weight = Eigen::ArrayXd::Ones(values.size());
  Eigen::VectorXd off = values;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::VectorXd root = weight.sqrt();
    off = values - columns * SolveShortest(Eigen::MatrixXd(root.asDiagonal() * columns), Eigen::VectorXd(root.cwiseProduct(values)));
    const double usual = RobustDeviation(off);
    if (!(usual > 0.0)) break;
    weight = (1.0 - (off.array().abs() / (kTukey * usual)).min(1.0).square()).square();
  }
  return off;
}

}  // namespace

Eigen::VectorXd AtTargets(const Eigen::MatrixXd& targets, const Eigen::VectorXd& values) {
  return (targets.transpose() * values).cwiseQuotient(targets.colwise().sum().transpose());
}

Eigen::VectorXd OffSmoothCurve(const Eigen::VectorXd& target_rad, const Eigen::VectorXd& error_rad, Eigen::Index waves) {
  return OffMostOf(Between(target_rad).At(target_rad, waves), error_rad);
}

Eigen::VectorXd OffFewOrders(const Eigen::VectorXd& target_rad, const Eigen::VectorXd& error_rad) {
  constexpr int kMostOrders = 4, kHighest = 24;
  constexpr double kClearlyLess = 0.7;
  const int highest = std::min(kHighest, static_cast<int>(target_rad.size()) / 5);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Ones(target_rad.size(), 1);
  Eigen::VectorXd off = OffMostOf(columns, error_rad);
  for (int count = 0; count < kMostOrders; ++count) {
    Eigen::VectorXd least = off;
    int best = 0;
    for (int order = 1; order <= highest; ++order) {
      Eigen::MatrixXd with(columns.rows(), columns.cols() + 2);
      with << columns, model::Wave(order * target_rad);
      const Eigen::VectorXd now = OffMostOf(with, error_rad);
      if (!(RobustDeviation(now) < RobustDeviation(least))) continue;
      least = now;
      best = order;
    }
    if (!(RobustDeviation(least) < kClearlyLess * RobustDeviation(off))) break;
    columns.conservativeResize(Eigen::NoChange, columns.cols() + 2);
    columns.rightCols(2) = model::Wave(best * target_rad);
    off = least;
  }
  return off;
}

Accepted ErrorCurve(const Eigen::VectorXd& error_rad) {
  Accepted curve;
  curve.family.kind = Kind::kUnknown;
  curve.family.effect = "error curve";
  curve.family.where = "angle";
  curve.family.amplitudes = {{"strength", "1", 1.0, 1.0}};
  curve.amplitudes = Eigen::VectorXd::Ones(1);
  curve.columns = error_rad;
  return curve;
}

Accepted CurveThrough(const SignalContext& context, const Eigen::MatrixXd& targets, const Eigen::VectorXd& error_rad) {
  constexpr Eigen::Index kMostWaves = 100;  // of a file that somebody may still read
  Accepted curve = ErrorCurve(error_rad);
  const bool is_everywhere = targets.sum() == static_cast<double>(targets.rows());
  if (targets.cols() > kMostWaves || !is_everywhere) return curve;
  const Eigen::VectorXd target_rad = AtTargets(targets, context.device_rad);
  const HalfPeriods modes = Between(target_rad);
  const Eigen::VectorXd sizes_rad =
      SolveShortest(modes.At(target_rad, targets.cols()), AtTargets(targets, error_rad));
  curve.family.products = [modes, sizes_rad](const Eigen::VectorXd&, int) { return ProductsOf(modes, sizes_rad); };
  return curve;
}

}  // namespace twinbench::diagnose::encoder
