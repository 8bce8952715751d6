#include "twin/benches/encoder_comparison/diagnosis/harmonic_table.h"

#include <algorithm>
#include <string>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/candidates.h"
#include "twin/diagnose/engine/projector.h"

namespace twinbench::diagnose::encoder {
namespace {

constexpr int kMostTableOrders = 12;

/// Orders alone name no cause: several faults have the same one.
std::string MeaningOf(int order) {
  switch (order) {
    case 1:
      return "scale or magnet off centre, or an offset of the sine and cosine signals; also a reference that is "
             "off centre. One mounting does not separate them: turn the device on the shaft";
    case 2:
      return "scale or magnet tilted or out of round, or sine and cosine signals of unequal size or not a quarter "
             "period apart; not separable at one mounting";
    case 4:
      return "saturated or clipped signals (then orders 8 and 12 come along in fixed ratios), a nonlinear sensor, "
             "or four screws or poles";
    case 8:
    case 12:
      return "goes with order 4 where signals are clipped; else screws, poles or a polygon of this number";
    default:
      return "screws, poles, teeth or a polygon of this number; no fault of two sinusoidal signals alone";
  }
}

Eigen::MatrixXd Waves(const Eigen::VectorXd& angle_rad, int orders) {
  Eigen::MatrixXd waves(angle_rad.size(), 2 * orders);
  for (int k = 1; k <= orders; ++k) {
    waves.col(2 * k - 2) = (k * angle_rad.array()).cos();
    waves.col(2 * k - 1) = (k * angle_rad.array()).sin();
  }
  return waves;
}

Harmonic OrderOf(int order, const Eigen::Vector2d& x, const Eigen::Matrix2d& cov) {
  const Polar polar = PolarOf(x, cov);
  return {order, polar.size, polar.u_size, polar.phase_rad, polar.u_phase_rad, MeaningOf(order)};
}

/// Whether the readings tell the columns apart: of less than a turn they do not, and sizes are then a thousand
/// times too large, each against the next. A column's variance beside the others over that of the column alone.
bool AreToldApart(const Eigen::MatrixXd& normal, const Eigen::MatrixXd& inverse) {
  constexpr double kMostInflation = 100.0;
  return (normal.diagonal().array() * inverse.diagonal().array() < kMostInflation).all();
}

}  // namespace

std::vector<Harmonic> HarmonicTable(const EncoderRun& encoder, const NoiseModel& noise) {
  const LinearRun& run = encoder.run;
  const int orders = std::min(kMostTableOrders, LargestOrder(encoder.context));
  if (orders < 1) return {};
  const Projector projector(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  const Eigen::MatrixXd S = noise.Whiten(run, Waves(encoder.context.device_rad, orders));
  const Eigen::MatrixXd white = noise.Whiten(run, Eigen::MatrixXd(run.residual)), projected = projector.Apply(S);
  const Eigen::MatrixXd normal = S.transpose() * projected;
  const Eigen::MatrixXd inverse = InverseOfSymmetric(normal);
  if (!AreToldApart(normal, inverse)) return {};
  const Eigen::VectorXd x = SolveSymmetric(normal, Eigen::VectorXd(projected.transpose() * white.col(0)));
  const Eigen::VectorXd left = projector.Apply(white - S * x).col(0);
  const double scale2 = left.squaredNorm() / std::max(1.0, projector.DegreesOfFreedom() - 2.0 * orders);
  const Eigen::MatrixXd cov = scale2 * inverse;
  std::vector<Harmonic> table;
  for (int k = 1; k <= orders; ++k) {
    table.push_back(OrderOf(k, x.segment<2>(2 * k - 2), cov.block<2, 2>(2 * k - 2, 2 * k - 2)));
  }
  return table;
}

}  // namespace twinbench::diagnose::encoder
