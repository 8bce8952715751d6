#include "twin/benches/circular_motion/twin/twin.h"

#include <array>
#include <cmath>

#include "twin/benches/circular_motion/format.h"
#include "twin/benches/circular_motion/twin/effects.h"
#include "twin/benches/circular_motion/twin/instruments.h"
#include "twin/core/signal_effect.h"
#include "twin/model/signals.h"
#include "twin/sim/courses.h"
#include "twin/sim/effect_parameter.h"

namespace twinbench::sim {
namespace {

using benches::circular::Deviation;

Eigen::VectorXd Times_s(const std::vector<Reading>& course) {
  Eigen::VectorXd time_s(std::ssize(course));
  for (std::size_t i = 0; i < course.size(); ++i) time_s[static_cast<Eigen::Index>(i)] = ToSeconds(course[i].time);
  return time_s;
}

/// Cosine and sine in time.
double Tone(const EffectSettings& e, double time_s) {
  const double phase_rad = units::turn * Parameter(e, "frequency") * time_s;
  return Parameter(e, "cosine") * std::cos(phase_rad) + Parameter(e, "sine") * std::sin(phase_rad);
}

}  // namespace

CircleTwin::CircleTwin(const Scenario& scenario, const std::vector<Reading>& course, const Eigen::VectorXd& above_K)
    : scenario_(scenario),
      settings_(WithEffects(CircularOf(scenario), scenario.effects)),
      machine_(settings_.machine),
      course_(course),
      above_K_(above_K),
      radial_(scenario.empiricals, "radial"),
      tangential_(scenario.empiricals, "tangential") {
  AddToMachine(scenario.effects, machine_);
  for (std::size_t k = 0; k < scenario.effects.size(); ++k) {
    const EffectSettings& effect = scenario.effects[k];
    if (effect.name == kSignalEffect) signals_.emplace_back(effect, benches::circular::Format());
    if (effect.name != "drift") continue;
    const double lag_s = Parameter(effect, "lag");
    lagged_K_[k] = lag_s > 0.0 ? model::Lagged(Times_s(course), above_K, lag_s) : above_K;
  }
}

/// As the readings say; where nothing has been read yet, as the scenario says.
bool CircleTwin::IsBar(const Reading& r) const {
  using namespace benches::circular;
  if (std::isfinite(kGridX_m(r))) return false;
  if (std::isfinite(kBar_m(r)) || std::isfinite(kEncoder_rad(r))) return true;
  const auto setup = static_cast<std::size_t>(r.setup);
  return setup >= settings_.procedure.setups.size() || settings_.procedure.setups[setup].IsBar();
}

CircleInstant CircleTwin::InstantOf(std::size_t i) const {
  const Reading& r = course_[i];
  return {r.target_rad, benches::circular::Radius_m(r), r.direction, benches::circular::kFeed_m_s(r),
          above_K_[static_cast<Eigen::Index>(i)]};
}

/// By effects that follow time or the reading's number.
Eigen::Vector2d CircleTwin::Moved_m(std::size_t i) const {
  Eigen::Vector2d moved_m = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < scenario_.effects.size(); ++k) {
    const EffectSettings& e = scenario_.effects[k];
    const Eigen::Index axis = e.where == "y" ? 1 : 0;
    if (e.name == "slip") moved_m[axis] += StepAt(e, course_[i].reading);
    if (e.name == "drift") moved_m[axis] += Parameter(e, "drift") * lagged_K_.at(k)[static_cast<Eigen::Index>(i)];
  }
  return moved_m;
}

Eigen::Vector2d CircleTwin::Position_m(std::size_t i, double latency_s) const {
  return machine_.Position_m(InstantOf(i).Before(latency_s)) + Moved_m(i);
}

Deviation CircleTwin::Bar(std::size_t i, const CircleExtra& extra) const {
  const CircleInstant at = InstantOf(i);
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
  const CircleInstant at = InstantOf(i);
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
  const Reading& r = course_[i];
  const double time_s = ToSeconds(r.time);
  const model::Instant now{.time_s = time_s,
                           .reading = r.reading,
                           .direction = static_cast<double>(r.direction),
                           .velocity_rad_s = r.velocity_rad_s,
                           .above_K = above_K_[static_cast<Eigen::Index>(i)],
                           .angle_rad = {r.target_rad, 0.0}};
  const std::array<double, 2> without_m = {shown.radial_m, shown.tangential_m};
  for (const model::Product& signal : signals_)
    (signal.Channel() == 0 ? shown.radial_m : shown.tangential_m) += signal.At(now, without_m);
  for (const EffectSettings& e : scenario_.effects) {
    if (e.name == "tone") shown.radial_m += Tone(e, time_s);
  }
  shown.radial_m += radial_.At(r.reading);
  shown.tangential_m += tangential_.At(r.reading);
}

Deviation CircleTwin::At(std::size_t i, const CircleExtra& extra) const {
  Deviation shown = IsBar(course_[i]) ? Bar(i, extra) : Grid(i, extra);
  AddSignals(i, shown);
  shown.radial_m += extra.radial_m;
  shown.tangential_m += extra.tangential_m;
  return shown;
}

}  // namespace twinbench::sim
