#include "twin/benches/rotary_4dof/diagnosis/linearisation.h"

#include <Eigen/SparseCore>
#include <cmath>

#include "twin/benches/rotary_4dof/diagnosis/free_parameters.h"
#include "twin/benches/rotary_4dof/diagnosis/published_equations.h"
#include "twin/benches/rotary_4dof/estimators/grating_model.h"
#include "twin/benches/rotary_4dof/estimators/prediction.h"
#include "twin/core/errors.h"

namespace twinbench::diagnose::rotary {
namespace {

using separate::Design;
using Entry = Eigen::Triplet<double>;

/// The goniometer sweeps the grating on its mounting.
Vector4 CalibrationMotion(const Configuration& configuration, const Vector4& mount) {
  const Matrix3 swept =
      measure::MotionRotation({configuration.swept_yaw_rad, configuration.swept_tilt_rad, 0.0, 0.0});
  const Matrix3 turn = swept * measure::MotionRotation(mount);
  return {std::atan2(turn(1, 0), turn(0, 0)), std::atan2(turn(2, 1), turn(2, 2)), -std::asin(turn(2, 0)), mount[3]};
}

/// Motions in full circles, four rows a stop, lengths in the length unit.
Eigen::VectorXd CircleMotions(const RotaryRun& rotary, const std::vector<Configuration>& configurations,
                              const Eigen::VectorXd& x) {
  std::vector<separate::Cell> cells;
  for (const Configuration& configuration : configurations) {
    if (configuration.setup >= 0)
      cells.push_back({configuration.setup, configuration.target, measure::Matrix4::Zero()});
  }
  return separate::PredictCells(rotary.design, cells, x.head(rotary.design.Unknowns()), rotary.geometry);
}

std::vector<Vector4> Motions(const RotaryRun& rotary, const std::vector<Configuration>& configurations,
                             const Eigen::VectorXd& x) {
  const Eigen::VectorXd circles = CircleMotions(rotary, configurations, x);
  const Vector4 mount = x.segment<4>(CalibrationMountColumn(rotary.design)).cwiseQuotient(separate::UnitScale());
  std::vector<Vector4> motions;
  Eigen::Index next = 0;
  for (const Configuration& configuration : configurations) {
    motions.push_back(configuration.setup < 0
                          ? CalibrationMotion(configuration, mount)
                          : Vector4(circles.segment<4>(4 * next++).cwiseQuotient(separate::UnitScale())));
  }
  return motions;
}

/// As the twin is asked: in the calibration only the mounting is free.
std::vector<Vector4> FreeMotions(const RotaryRun& rotary, const std::vector<Configuration>& configurations,
                                 const Eigen::VectorXd& x) {
  const Vector4 mount = x.segment<4>(CalibrationMountColumn(rotary.design)).cwiseQuotient(separate::UnitScale());
  std::vector<Vector4> free = rotary.motion;
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (configurations[i].setup < 0) free[i] = mount;
  }
  return free;
}

/// Columns of the unknowns that move the grating.
/// @param K  d shown / d motion at the reading whose rows begin at `row`.
void AddMotionColumns(const Design& design, const Configuration& configuration, int row, const Eigen::Matrix4d& K,
                      std::vector<Entry>& entries) {
  const Eigen::Matrix4d scaled = K * separate::UnitScale().cwiseInverse().asDiagonal();
  const auto add = [&](int column, const Vector4& d_motion) {
    const Vector4 shown = scaled * d_motion;
    for (int c = 0; c < kChannels; ++c) {
      if (shown[c] != 0.0) entries.emplace_back(row + c, column, shown[c]);
    }
  };
  if (configuration.setup < 0) {
    for (int k = 0; k < separate::kMountUnknowns; ++k) add(CalibrationMountColumn(design) + k, Vector4::Unit(k));
    return;
  }
  const separate::StopModel stop = separate::ModelStop(design, configuration.setup, configuration.target);
  for (int k = 0; k < stop.columns; ++k) add(stop.column[static_cast<std::size_t>(k)], stop.d.col(k));
}

/// d shown / d motion at every reading.
std::vector<Eigen::Matrix4d> MotionSlopes(const RotaryRun& rotary) {
  std::vector<Eigen::Matrix4d> slopes;
  if (rotary.published) {
    for (const Vector4& motion : rotary.motion) slopes.push_back(PublishedSlopes(rotary.geometry, motion));
    return slopes;
  }
  slopes.resize(rotary.motion.size());
  const std::array<const char*, 4> points = {"mount.ez", "mount.ex", "mount.ey", "mount.dy"};
  for (int k = 0; k < 4; ++k) {
    const Eigen::VectorXd rows_m = rotary.twin->Slope_m(points[static_cast<std::size_t>(k)], rotary.free);
    for (std::size_t i = 0; i < slopes.size(); ++i)
      slopes[i].col(k) = rows_m.segment<4>(kChannels * static_cast<Eigen::Index>(i));
  }
  return slopes;
}

void AddCalibratedColumns(const RotaryRun& rotary, std::vector<Entry>& entries) {
  const int first = CalibratedColumn(rotary.design);
  for (int k = 0; k < kCalibrated; ++k) {
    const auto& [constant, sd] = CalibratedConstants()[static_cast<std::size_t>(k)];
    const Eigen::VectorXd slope = rotary.twin->Slope_m(constant, sd, rotary.free);
    for (int row = 0; row < slope.size(); ++row) entries.emplace_back(row, first + k, slope[row]);
  }
}

/// The published equations, with what the scenario's effects do on top of them.
Eigen::VectorXd PublishedRows_m(const RotaryRun& rotary, const Eigen::VectorXd& by_effects_m) {
  Eigen::VectorXd shown_m = by_effects_m;
  for (std::size_t i = 0; i < rotary.motion.size(); ++i)
    shown_m.segment<4>(kChannels * static_cast<Eigen::Index>(i)) +=
        PublishedSpots_m(rotary.geometry, rotary.motion[i]);
  return shown_m;
}

}  // namespace

void Compare(const std::vector<Configuration>& configurations, const Eigen::VectorXd& x,
             const RotaryTwin* without_effects, RotaryRun& rotary) {
  rotary.motion = Motions(rotary, configurations, x);
  rotary.free = FreeMotions(rotary, configurations, x);
  LinearRun& run = rotary.run;
  if (!rotary.published) {
    run.residual = run.observed - rotary.twin->Shown_m(rotary.free);
    return;
  }
  Eigen::VectorXd by_effects_m = Eigen::VectorXd::Zero(run.Rows());
  if (without_effects) by_effects_m = rotary.twin->Shown_m(rotary.free) - without_effects->Shown_m(rotary.free);
  run.residual = run.observed - PublishedRows_m(rotary, by_effects_m);
}

void Linearise(const std::vector<Configuration>& configurations, bool calibrated_too, RotaryRun& rotary) {
  LinearRun& run = rotary.run;
  const std::vector<Eigen::Matrix4d> slopes = MotionSlopes(rotary);
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < configurations.size(); ++i)
    AddMotionColumns(rotary.design, configurations[i], kChannels * static_cast<int>(i), slopes[i], entries);
  if (calibrated_too && !rotary.published) AddCalibratedColumns(rotary, entries);
  run.nuisance.jacobian.resize(run.Rows(), UnknownsOf(rotary.design));
  run.nuisance.jacobian.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace twinbench::diagnose::rotary
