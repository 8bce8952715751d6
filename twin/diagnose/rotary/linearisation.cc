#include "twin/diagnose/rotary/linearisation.h"

#include <Eigen/SparseCore>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/diagnose/rotary/free_parameters.h"
#include "twin/diagnose/rotary/known_effects.h"
#include "twin/measure/calibrate.h"
#include "twin/measure/grating_model.h"
#include "twin/separate/prediction.h"

namespace twinbench::diagnose::rotary {
namespace {

using separate::Design;
using Entry = Eigen::Triplet<double>;

/// The goniometer sweeps the grating on its mounting.
Vector4 CalibrationMotion(const Stance& stance, const Vector4& mount) {
  const Matrix3 swept = measure::MotionRotation({stance.swept_yaw_rad, stance.swept_tilt_rad, 0.0, 0.0});
  const Matrix3 turn = swept * measure::MotionRotation(mount);
  return {std::atan2(turn(1, 0), turn(0, 0)), std::atan2(turn(2, 1), turn(2, 2)), -std::asin(turn(2, 0)), mount[3]};
}

/// Motions in full circles, four rows a stop, lengths in the length unit.
Eigen::VectorXd CircleMotions(const RotaryRun& rotary, const std::vector<Stance>& stances,
                              const Eigen::VectorXd& x) {
  std::vector<separate::Cell> cells;
  for (const Stance& stance : stances) {
    if (stance.setup >= 0) cells.push_back({stance.setup, stance.target, measure::Matrix4::Zero()});
  }
  return separate::PredictCells(rotary.design, cells, x.head(rotary.design.Unknowns()), rotary.bench.nominal);
}

std::vector<Vector4> Motions(const RotaryRun& rotary, const std::vector<Stance>& stances,
                             const Eigen::VectorXd& x) {
  const Eigen::VectorXd circles = CircleMotions(rotary, stances, x);
  const Vector4 mount = x.segment<4>(CalibrationMountColumn(rotary.design)).cwiseQuotient(separate::UnitScale());
  std::vector<Vector4> motions;
  Eigen::Index next = 0;
  for (const Stance& stance : stances) {
    motions.push_back(stance.setup < 0
                          ? CalibrationMotion(stance, mount)
                          : Vector4(circles.segment<4>(4 * next++).cwiseQuotient(separate::UnitScale())));
  }
  return motions;
}

OpticalBench BenchAt(const RotaryRun& rotary, Eigen::Index reading, const Scenario& scenario) {
  const double T_degC = rotary.run.schedule.temperature_degC[reading];
  const double above_K = std::isfinite(T_degC) ? T_degC - scenario.environment.reference_degC : 0.0;
  return WithKnownEffects(rotary.bench, scenario, above_K);
}

/// Columns of the unknowns that move the grating.
/// @param K  d shown / d motion at the reading whose rows begin at `row`.
void AddMotionColumns(const Design& design, const Stance& stance, int row, const Eigen::Matrix4d& K,
                      std::vector<Entry>& entries) {
  const Eigen::Matrix4d scaled = K * separate::UnitScale().cwiseInverse().asDiagonal();
  const auto add = [&](int column, const Vector4& d_motion) {
    const Vector4 shown = scaled * d_motion;
    for (int c = 0; c < kChannels; ++c) {
      if (shown[c] != 0.0) entries.emplace_back(row + c, column, shown[c]);
    }
  };
  if (stance.setup < 0) {
    for (int k = 0; k < separate::kMountUnknowns; ++k) add(CalibrationMountColumn(design) + k, Vector4::Unit(k));
    return;
  }
  const separate::StopModel stop = separate::ModelStop(design, stance.setup, stance.target);
  for (int k = 0; k < stop.columns; ++k) add(stop.column[static_cast<std::size_t>(k)], stop.d.col(k));
}

/// d shown / d calibrated parameter k by central differences over its standard deviation.
Vector4 CalibratedSlope(OpticalBench bench, int k, const Vector4& motion) {
  double& parameter = CalibratedParameter(bench, k);
  const double step = CalibratedSd(k), kept = parameter;
  parameter = kept + step;
  const Vector4 above = ShownSpots(bench, motion);
  parameter = kept - step;
  return (above - ShownSpots(bench, motion)) / (2.0 * step);
}

void AddCalibratedColumns(const Design& design, int row, const OpticalBench& bench, const Vector4& motion,
                          std::vector<Entry>& entries) {
  for (int k = 0; k < kCalibrated; ++k) {
    const Vector4 slope = CalibratedSlope(bench, k, motion);
    for (int c = 0; c < kChannels; ++c) entries.emplace_back(row + c, CalibratedColumn(design) + k, slope[c]);
  }
}

/// What the closed forms say that the readings should have been, by row [m].
Eigen::VectorXd ModelledSpots(const RotaryRun& rotary, const Scenario& scenario) {
  Eigen::VectorXd shown_m = KnownSignal(scenario, ContextOf(rotary, scenario, rotary.run.observed));
  for (std::size_t i = 0; i < rotary.motion.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    shown_m.segment<4>(kChannels * at) += ShownSpots(BenchAt(rotary, at, scenario), rotary.motion[i]);
  }
  return shown_m;
}

/// What the twin says. The free motions come in between the grating and what carries it; in the calibration these
/// are the mounting's alone, because the twin itself puts the grating where the autocollimator saw it.
Eigen::VectorXd FollowedSpots(const RotaryRun& rotary, const std::vector<Stance>& stances, const Eigen::VectorXd& x,
                              const model::Follow& twin) {
  const Vector4 mount = x.segment<4>(CalibrationMountColumn(rotary.design)).cwiseQuotient(separate::UnitScale());
  Eigen::MatrixXd free(std::ssize(stances), 4);
  for (std::size_t i = 0; i < stances.size(); ++i)
    free.row(static_cast<Eigen::Index>(i)) = stances[i].setup < 0 ? mount : rotary.motion[i];
  const Eigen::MatrixXd shown_V = twin.Predict(
      {{"mount.ez", free.col(0)}, {"mount.ex", free.col(1)}, {"mount.ey", free.col(2)}, {"mount.dy", free.col(3)}});
  Eigen::VectorXd shown_m(rotary.run.observed.size());
  for (Eigen::Index i = 0; i < shown_V.rows(); ++i) {
    if (!shown_V.row(i).allFinite())
      throw InputError("reading " + std::to_string(rotary.run.schedule.reading[static_cast<std::size_t>(i)]),
                       "it has a value where the scenario's bench would show none",
                       "a scenario of the bench that the readings come from");
    const std::array<double, kChannels> reading_V = {shown_V(i, 0), shown_V(i, 1), shown_V(i, 2), shown_V(i, 3)};
    shown_m.segment<4>(kChannels * i) = measure::OnSurface(reading_V, rotary.bench.nominal);
  }
  return shown_m;
}

}  // namespace

void Linearise(const Scenario& scenario, const std::vector<Stance>& stances, const Eigen::VectorXd& x,
               const model::Follow* twin, RotaryRun& rotary) {
  LinearRun& run = rotary.run;
  rotary.motion = Motions(rotary, stances, x);
  run.residual = run.observed - (twin ? FollowedSpots(rotary, stances, x, *twin) : ModelledSpots(rotary, scenario));
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < stances.size(); ++i) {
    const int row = kChannels * static_cast<int>(i);
    const OpticalBench bench = BenchAt(rotary, static_cast<Eigen::Index>(i), scenario);
    const Vector4& motion = rotary.motion[i];
    AddMotionColumns(rotary.design, stances[i], row, ShownJacobian(bench, motion), entries);
    if (!bench.published) AddCalibratedColumns(rotary.design, row, bench, motion, entries);
  }
  run.nuisance.jacobian.resize(run.Rows(), UnknownsOf(rotary.design));
  run.nuisance.jacobian.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace twinbench::diagnose::rotary
