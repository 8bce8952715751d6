#include "twin/benches/rotary_4dof/estimators/prediction.h"

#include <cmath>

namespace twinbench::separate {
namespace {

/// The unknowns of one stop as pose errors; what nobody reads is zero.
PoseErrors ErrorsOf(const Design& design, const Cell& cell, const Eigen::VectorXd& x) {
  const SetUp& setup = design.setups[static_cast<std::size_t>(cell.setup)];
  const int reference = design.ReferencePosition(setup, cell.target);
  const double L = kLengthUnit_m;
  const auto t = x.segment<kTargetSeries>(design.Column(Series::kTargetEx, cell.target));
  const auto r = x.segment<kSeries - kTargetSeries>(design.Column(Series::kRefEx, reference));
  const Vector4 mount = x.segment<kMountUnknowns>(design.MountColumn(cell.setup));
  PoseErrors errors;
  errors.target << t[0], t[1], t[2], 0.0, L * t[3], 0.0;
  errors.reference << r[0], r[1], r[2], L * r[3], L * r[4], 0.0;
  errors.mount << mount[1], mount[2], mount[0], 0.0, L * mount[3], 0.0;
  if (setup.clamping == Clamping::kReclamp) return errors;
  const Vector4 seat = x.segment<kSeatUnknowns>(design.SeatColumn(cell.setup));
  errors.seat << seat[0], seat[1], 0.0, L * seat[2], L * seat[3], 0.0;
  return errors;
}

/// Mean squares of angles and lengths, [rad^2, kLengthUnit_m^2].
struct Squares {
  double angle = 0.0;
  double length = 0.0;
};

Squares TableSquares(const Design& design, const Eigen::VectorXd& x) {
  Squares sum;
  int angles = 0, lengths = 0;
  for (int s = 0; s < kSeries; ++s) {
    const auto series = static_cast<Series>(s);
    const bool is_length = series == Series::kTargetDy || series >= Series::kRefDx;
    if (series == Series::kRefDx) continue;  // as a rule nobody reads it
    (is_length ? lengths : angles) += design.n;
    for (int i = 0; i < design.n; ++i) {
      (is_length ? sum.length : sum.angle) += std::pow(x[design.Column(series, i)], 2);
    }
  }
  return {sum.angle / angles, sum.length / lengths};
}

Squares MountSquares(const Design& design, const Eigen::VectorXd& x) {
  Squares sum;
  for (int s = 0; s < static_cast<int>(design.setups.size()); ++s) {
    const Vector4 mount = x.segment<kMountUnknowns>(design.MountColumn(s));
    sum.angle += mount.head<3>().squaredNorm() / 3.0;
    sum.length += mount[3] * mount[3];
  }
  const double setups = static_cast<double>(design.setups.size());
  return {sum.angle / setups, sum.length / setups};
}

}  // namespace

Eigen::VectorXd PredictCells(const Design& design, const std::vector<Cell>& cells, const Eigen::VectorXd& x,
                             const BenchGeometry& geometry) {
  Eigen::VectorXd predicted(measure::kDofs * std::ssize(cells));
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const SetUp& setup = design.setups[static_cast<std::size_t>(cells[k].setup)];
    const Pose X_LG = GratingPose(design.StopAt(setup, cells[k].target), ErrorsOf(design, cells[k], x), geometry);
    predicted.segment<4>(4 * static_cast<Eigen::Index>(k)) = MotionOf(X_LG).cwiseProduct(UnitScale());
  }
  return predicted;
}

Vector4 UnreadSecondOrder(const Design& design, const Eigen::VectorXd& x) {
  const Squares tables = TableSquares(design, x), mounts = MountSquares(design, x);
  const double angle2 = tables.angle + mounts.angle;
  const double length_m = kLengthUnit_m * std::sqrt(tables.length + mounts.length);
  const double dy_m = design.target_height_m * angle2 + std::sqrt(angle2) * length_m;
  return {angle2, angle2, angle2, dy_m};
}

}  // namespace twinbench::separate
