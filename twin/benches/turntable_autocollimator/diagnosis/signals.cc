#include "twin/benches/turntable_autocollimator/diagnosis/signals.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/units.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::turntable {
namespace {

/// Azimuth that the mirror faces in L: the autocollimator stands on the side of +y.
constexpr double kFacing_rad = 90.0 * units::deg;

/// A stop: the turntable moves while the multi-tooth table is lifted, turned and seated; then the dwell.
Eigen::VectorXd SinceArrival_s(const Schedule& s, const Scenario& scenario) {
  const double left_s = TurntableOf(scenario).multitooth.index_time_s - TurntableOf(scenario).turntable.move_time_s;
  return s.dwell_s.array() + std::max(left_s, TurntableOf(scenario).turntable.settle_s);
}

/// Of the first stop a short move, the stop and the dwell lie between the mounting and the reading.
Eigen::VectorXd SinceMounting_s(const Schedule& s, const Scenario& scenario) {
  const TableSettings& turntable = TurntableOf(scenario).turntable;
  const double first_move_s =
      turntable.move_time_s + turntable.settle_s + TurntableOf(scenario).multitooth.index_time_s;
  std::map<int, double> mounted_s;
  Eigen::VectorXd since_s(s.Readings());
  for (int i = 0; i < s.Readings(); ++i) {
    const double dwell_s = std::isfinite(s.dwell_s[i]) ? s.dwell_s[i] : 0.0;
    const int setup = s.setup[static_cast<std::size_t>(i)];
    since_s[i] = s.time_s[i] - mounted_s.try_emplace(setup, s.time_s[i] - dwell_s - first_move_s).first->second;
  }
  return since_s;
}

/// The multi-tooth table's axis goes round with the turntable; what lies across the beam counts. To the left of
/// somebody who looks along the mirror's normal is positive, so that a hollow mirror shows a positive x.
Eigen::VectorXd BeamWalk_m(const Schedule& s, const TurntableProcedureSettings& procedure) {
  Eigen::VectorXd walk_m(s.Readings());
  const int last = procedure.SetUps() - 1;
  for (int i = 0; i < s.Readings(); ++i) {
    const int setup = std::clamp(s.setup[static_cast<std::size_t>(i)], 0, last);
    const double eccentricity_m = TurntableProcedureSettings::Of(procedure.eccentricities_m, setup);
    const double azimuth_rad = TurntableProcedureSettings::Of(procedure.tilt_azimuths_rad, setup);
    walk_m[i] = eccentricity_m * std::sin(azimuth_rad + s.target_rad[i] - kFacing_rad);
  }
  return walk_m;
}

}  // namespace

SignalContext ContextOf(const Schedule& schedule, const Scenario& scenario) {
  SignalContext context;
  context.schedule = schedule;
  context.since_mounting_s = SinceMounting_s(schedule, scenario);
  context.since_arrival_s = SinceArrival_s(schedule, scenario);
  if (model::HasTemperature(schedule))
    context.above_K = model::Above_K(schedule, scenario.environment.reference_degC);
  context.beam_walk_m = BeamWalk_m(schedule, TurntableOf(scenario).turntable_procedure);
  context.range_rad = TurntableOf(scenario).autocollimator.range_rad;
  context.pixel_rad =
      TurntableOf(scenario).collimator.pixel_pitch_m / (2.0 * TurntableOf(scenario).collimator.focal_length_m);
  context.mirror_width_m = TurntableOf(scenario).mirror.width_m;
  return context;
}

Eigen::VectorXd CreepSignal(const SignalContext& context, double time_constant_s) {
  return (context.since_mounting_s.array() / time_constant_s).log1p();
}

Eigen::VectorXd DirectionSignal(const SignalContext& context) {
  Eigen::VectorXd direction(context.Readings());
  for (Eigen::Index i = 0; i < direction.size(); ++i)
    direction[i] = context.schedule.direction[static_cast<std::size_t>(i)];
  return direction;
}

Eigen::VectorXd BacklashSignal(const SignalContext& context) {
  return -0.5 * DirectionSignal(context);
}

Eigen::VectorXd SettlingSignal(const SignalContext& context, double time_constant_s) {
  const auto waited_s = context.since_arrival_s.array();
  const Eigen::ArrayXd left = (-waited_s / time_constant_s).exp();
  return -DirectionSignal(context).array() * waited_s.isFinite().select(left, 0.0);
}

Eigen::VectorXd FlatnessSignal_per_m(const SignalContext& context) {
  return 8.0 / (context.mirror_width_m * context.mirror_width_m) * context.beam_walk_m;
}

Eigen::MatrixXd CubicSignals(const Eigen::MatrixXd& shown_rad, double range_rad, bool radial) {
  const Eigen::ArrayXXd u = shown_rad.array() / range_rad;
  if (!radial) return u.cube();
  const Eigen::ArrayXd squared = u.square().rowwise().sum();
  return u.colwise() * squared;
}

Eigen::VectorXd AsRows(const Eigen::MatrixXd& of_axes) {
  Eigen::VectorXd rows(of_axes.size());
  for (Eigen::Index i = 0; i < of_axes.rows(); ++i) rows.segment<kAxes>(kAxes * i) = of_axes.row(i);
  return rows;
}

}  // namespace twinbench::diagnose::turntable
