#include "twin/benches/circular_motion/twin/twin.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "twin/benches/circular_motion/format.h"
#include "twin/benches/circular_motion/settings.h"
#include "twin/benches/circular_motion/twin/effects.h"
#include "twin/core/frames.h"
#include "twin/core/signal_effect.h"
#include "twin/model/signals.h"
#include "twin/sim/courses.h"
#include "twin/sim/effect_parameter.h"

namespace twinbench::sim {
namespace {

/// From ball 1 to ball 2.
Eigen::Vector3d BarVector_m(const BarSettings& bar, const Eigen::Vector2d& p_m) {
  return {bar.offset_m[0] + p_m.x(), bar.offset_m[1] + p_m.y(), bar.height_m};
}

/// @param p_m      Of the spindle, from the commanded centre.
/// @param above_K  Temperature above that of reference.
double BarShown_m(const BarSettings& bar, const Eigen::Vector2d& p_m, double radius_m, double above_K) {
  const Eigen::Vector3d v_m = BarVector_m(bar, p_m);
  const double azimuth_rad = std::atan2(v_m.y(), v_m.x());
  double longer_m = v_m.norm() - (radius_m + bar.length_error_m) * (1.0 + bar.expansion_per_K * above_K);
  for (std::size_t k = 0; k < bar.ball_m.size(); ++k)
    longer_m += bar.ball_m[k] * std::cos((static_cast<double>(k) + 2.0) * (azimuth_rad - bar.ball_azimuth_rad[k]));
  return longer_m * (1.0 + bar.gain_error + bar.cubic_per_m2 * longer_m * longer_m);
}

/// In the turn about `commanded_rad`.
double EncoderShown_rad(const BarEncoderSettings& encoder, const BarSettings& bar, const Eigen::Vector2d& p_m,
                        double commanded_rad) {
  const Eigen::Matrix3d tilt = (Eigen::AngleAxisd(encoder.tilt_rad[1], Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(encoder.tilt_rad[0], Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  const Eigen::Vector3d v_m = tilt.transpose() * BarVector_m(bar, p_m);
  const double azimuth_rad = std::atan2(v_m.y(), v_m.x());
  const double shown_rad =
      azimuth_rad + encoder.eccentricity_rad * std::sin(azimuth_rad - encoder.eccentricity_azimuth_rad) +
      encoder.ellipticity_rad * std::sin(2.0 * (azimuth_rad - encoder.ellipticity_azimuth_rad)) + encoder.zero_rad;
  return commanded_rad + std::remainder(shown_rad - commanded_rad, units::turn);
}

Eigen::Vector2d GridShown_m(const GridSettings& grid, const Eigen::Vector2d& p_m) {
  const Eigen::Vector2d plate_m((1.0 + grid.scale[0]) * p_m.x() - grid.shear_rad * p_m.y(),
                                (1.0 + grid.scale[1]) * p_m.y());
  Eigen::Vector2d shown_m = Eigen::Rotation2Dd(grid.rotation_rad) * plate_m;
  shown_m += Eigen::Vector2d(grid.offset_m[0], grid.offset_m[1]);
  return shown_m + (grid.sde_m * (units::turn / grid.period_m * shown_m).array().sin()).matrix();
}

using benches::circular::Deviation;

/// As the readings say; where nothing has been read yet, as the scenario says.
bool IsBar(const Reading& r, const CircularProcedureSettings& procedure) {
  using namespace benches::circular;
  if (std::isfinite(kGridX_m(r))) return false;
  if (std::isfinite(kBar_m(r)) || std::isfinite(kEncoder_rad(r))) return true;
  const auto setup = static_cast<std::size_t>(r.setup);
  return setup >= procedure.setups.size() || procedure.setups[setup].IsBar();
}

CircleStep StepOf(const Reading& r, const CircularProcedureSettings& procedure, double above_K) {
  using namespace benches::circular;
  return {{r.target_rad, Radius_m(r), r.direction, kFeed_m_s(r), above_K},
          r.reading,
          r.setup,
          r.pass,
          ToSeconds(r.time),
          r.velocity_rad_s,
          IsBar(r, procedure)};
}

/// What a drift adds along its axis: in proportion to the temperature, or to one that lags behind it.
Eigen::VectorXd Drift_m(const EffectSettings& e, const std::vector<CircleStep>& steps) {
  Eigen::VectorXd time_s(std::ssize(steps)), above_K(std::ssize(steps));
  for (std::size_t i = 0; i < steps.size(); ++i) {
    time_s[static_cast<Eigen::Index>(i)] = steps[i].time_s;
    above_K[static_cast<Eigen::Index>(i)] = steps[i].at.above_K;
  }
  const double lag_s = Parameter(e, "lag");
  return Parameter(e, "drift") * (lag_s > 0.0 ? model::Lagged(time_s, above_K, lag_s) : above_K);
}

Eigen::Matrix2Xd Moved_m(const std::vector<EffectSettings>& effects, const std::vector<CircleStep>& steps) {
  Eigen::Matrix2Xd moved_m = Eigen::Matrix2Xd::Zero(2, std::ssize(steps));
  for (const EffectSettings& e : effects) {
    auto axis = moved_m.row(e.where == "y" ? 1 : 0);
    if (e.name == "drift") axis += Drift_m(e, steps).transpose();
    for (std::size_t i = 0; e.name == "slip" && i < steps.size(); ++i)
      axis[static_cast<Eigen::Index>(i)] += StepAt(e, steps[i].reading);
  }
  return moved_m;
}

double Tone(const EffectSettings& e, double time_s) {
  return Parameter(e, "amplitude") *
         std::cos(units::turn * Parameter(e, "frequency") * time_s + Parameter(e, "phase"));
}

/// What effects add to the lags of the scenario.
AxisPair Later_s(const CircularSettings& with_effects, const CircularSettings& stated) {
  const AxisPair &with_s = with_effects.machine.lag_s, &stated_s = stated.machine.lag_s;
  return {with_s[0] - stated_s[0], with_s[1] - stated_s[1]};
}

/// With bodies the lags are those of their drives.
CircularMachineSettings MachineOf(const CircularSettings& s, const AxisPair& later_s) {
  CircularMachineSettings machine = s.machine;
  if (!s.mechanics.HasBodies()) return machine;
  const DrivesInClosedForm drives = InClosedForm(s.drives);
  for (std::size_t k = 0; k < 2; ++k) machine.lag_s[k] = drives.lag_s[k] + later_s[k];
  return machine;
}

std::vector<CirclePlace> PlacesOf(const std::vector<CircleStep>& steps) {
  std::vector<CirclePlace> places;
  for (const CircleStep& step : steps) places.push_back({step.setup, step.pass, step.at});
  return places;
}

}  // namespace

CircleTwin::CircleTwin(const Scenario& scenario, const std::vector<Reading>& course, const Eigen::VectorXd& above_K,
                       BodiesOnce& bodies)
    : settings_(WithEffects(scenario)),
      later_s_(Later_s(settings_, CircularOf(scenario))),
      machine_(MachineOf(settings_, later_s_)),
      radial_(scenario.empiricals, "radial"),
      tangential_(scenario.empiricals, "tangential") {
  for (std::size_t i = 0; i < course.size(); ++i)
    steps_.push_back(StepOf(course[i], settings_.procedure, above_K[static_cast<Eigen::Index>(i)]));
  AddToMachine(scenario.effects, machine_);
  for (const EffectSettings& effect : scenario.effects) {
    if (effect.name == kSignalEffect) signals_.emplace_back(effect, benches::circular::Format());
    if (effect.name == "tone") tones_.push_back(effect);
    if (effect.name == "drift" || effect.name == "slip") moving_.push_back(effect);
  }
  Follow(bodies);
}

void CircleTwin::Follow(BodiesOnce& bodies) {
  if (settings_.mechanics.HasBodies()) bodies_ = bodies.Of(settings_, PlacesOf(steps_));
  moved_m_ = Moved_m(moving_, steps_);
}

void CircleTwin::Append(const Reading& reading, double above_K, BodiesOnce& bodies) {
  steps_.push_back(StepOf(reading, settings_.procedure, above_K));
  Follow(bodies);
}

Eigen::Vector2d CircleTwin::Position_m(std::size_t i, double latency_s) const {
  const CircleInstant at = steps_[i].at.Before(latency_s);
  const auto moved_m = moved_m_.col(static_cast<Eigen::Index>(i));
  if (!bodies_) return machine_.Position_m(at) + moved_m;
  const Eigen::Vector2d followed_m(bodies_->Position_m(i, 0, latency_s + later_s_[0]),
                                   bodies_->Position_m(i, 1, latency_s + later_s_[1]));
  return machine_.Position_m(at, followed_m) + moved_m;
}

Deviation CircleTwin::Bar(std::size_t i, const CircleExtra& extra) const {
  const CircleInstant& at = steps_[i].at;
  BarSettings bar = settings_.bar;
  BarEncoderSettings encoder = settings_.encoder;
  bar.offset_m[0] += extra.offset_x_m;
  bar.offset_m[1] += extra.offset_y_m;
  bar.length_error_m += extra.length_m;
  encoder.zero_rad += extra.rotation_rad;
  const Eigen::Vector2d moved_m(extra.x_m, extra.y_m);
  const double shown_rad =
      EncoderShown_rad(encoder, bar, Position_m(i, encoder.latency_s) + moved_m, at.commanded_rad);
  return {BarShown_m(bar, Position_m(i, bar.latency_s) + moved_m, at.radius_m, at.above_K),
          at.radius_m * (shown_rad - at.commanded_rad)};
}

Deviation CircleTwin::Grid(std::size_t i, const CircleExtra& extra) const {
  const CircleInstant& at = steps_[i].at;
  GridSettings grid = settings_.grid;
  grid.offset_m[0] += extra.offset_x_m;
  grid.offset_m[1] += extra.offset_y_m;
  grid.rotation_rad += extra.rotation_rad;
  const Eigen::Vector2d radial(std::cos(at.commanded_rad), std::sin(at.commanded_rad));
  const Eigen::Vector2d off_m =
      GridShown_m(grid, Position_m(i) + Eigen::Vector2d(extra.x_m, extra.y_m)) - at.radius_m * radial;
  return {radial.dot(off_m), radial.x() * off_m.y() - radial.y() * off_m.x()};
}

/// Structure that no effect of the catalogue has, on top of what is shown; and vibration of the radius.
void CircleTwin::AddSignals(std::size_t i, Deviation& shown) const {
  const CircleStep& step = steps_[i];
  const std::array<double, 2> without_m = {shown.radial_m, shown.tangential_m};
  if (!signals_.empty()) {
    const model::Instant now{.time_s = step.time_s,
                             .reading = step.reading,
                             .direction = static_cast<double>(step.at.direction),
                             .velocity_rad_s = step.velocity_rad_s,
                             .above_K = step.at.above_K,
                             .angle_rad = {step.at.commanded_rad, 0.0}};
    for (const model::Product& signal : signals_)
      (signal.Channel() == 0 ? shown.radial_m : shown.tangential_m) += signal.At(now, without_m);
  }
  for (const EffectSettings& tone : tones_) shown.radial_m += Tone(tone, step.time_s);
  shown.radial_m += radial_.At(step.reading, step.time_s);
  shown.tangential_m += tangential_.At(step.reading, step.time_s);
}

Deviation CircleTwin::At(std::size_t i, const CircleExtra& extra) const {
  Deviation shown = steps_[i].is_bar ? Bar(i, extra) : Grid(i, extra);
  AddSignals(i, shown);
  shown.radial_m += extra.radial_m;
  shown.tangential_m += extra.tangential_m;
  return shown;
}

}  // namespace twinbench::sim
