#include "twin/benches/circular_motion/twin/bodies.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "twin/core/errors.h"

namespace twinbench::sim {
namespace {

using mechanics::CircleAxis, mechanics::CircleMotion, mechanics::FeedLeg;

constexpr std::array<CircleAxis, 2> kCircleAxes = {CircleAxis::kX, CircleAxis::kY};
constexpr double kBehind_s = 3.0;  // a latency of -1 s of a key, of an effect, and a lag of an effect

mechanics::FeedDriveParameters ParametersOf(const FeedDrivesSettings& s, std::size_t k) {
  mechanics::FeedDriveParameters p;
  p.mass_kg = s.mass_kg[k];
  p.screw_inertia_kg_m2 = s.screw_inertia_kg_m2[k];
  p.lead_m = s.lead_m[k];
  p.axial_stiffness_N_m = s.stiffness_N_m[k];
  p.torsional_stiffness_Nm_rad = s.torsion_Nm_rad[k];
  p.damping_ratio = s.damping_ratio;
  p.play_m = s.play_m[k];
  p.friction.coulomb_N = s.friction_N[k];
  p.friction.static_ratio = s.static_ratio;
  p.friction.stribeck_m_s = s.stribeck_m_s;
  p.friction.presliding_m = s.presliding_m;
  p.friction.viscous_N_s_m = s.viscous_N_s_m[k];
  p.position_gain_1_s = s.position_gain_1_s[k];
  p.velocity_gain_1_s = s.velocity_gain_1_s[k];
  p.integral_time_s = s.integral_time_s[k];
  p.feed_forward = s.feed_forward[k];
  p.encoder = s.encoder == "slide" ? mechanics::FeedEncoder::kSlide : mechanics::FeedEncoder::kMotor;
  p.servo_period_s = s.servo_period_s;
  p.step_s = s.step_s;
  return p;
}

mechanics::FeedDrive DriveOf(const CircularSettings& s, std::size_t k) {
  try {
    return {mechanics::FidelityFromName(s.mechanics.fidelity), ParametersOf(s.drives, k), kCircleAxes[k]};
  } catch (const std::invalid_argument& error) {
    throw InputError(k == 0 ? "[drives], axis x" : "[drives], axis y", error.what(), "a drive that can run");
  }
}

/// At least half a circle before `to_rad`, where both axes are in mid-travel.
double LeadIn_rad(double to_rad, int direction) {
  const double along = direction * to_rad - units::kPi;  // the angle counted along the motion
  const double quarter = 0.5 * units::kPi;
  return direction * (quarter * (std::floor(along / quarter - 0.5) + 0.5));
}

bool SamePass(const CirclePlace& a, const CirclePlace& b) {
  constexpr double kRounding = 1e-6;  // of records, relative
  const auto same = [](double x, double y) { return std::abs(x - y) <= kRounding * std::abs(x); };
  const bool onwards = b.at.direction * (b.at.commanded_rad - a.at.commanded_rad) > 0.0;
  return a.setup == b.setup && a.pass == b.pass && a.at.direction == b.at.direction &&
         same(a.at.radius_m, b.at.radius_m) && same(a.at.feed_m_s, b.at.feed_m_s) &&
         (onwards || a.at.feed_m_s == 0.0);
}

const CircleMotion& MotionAt(const std::vector<FeedLeg>& legs, double time_s) {
  const auto leg = std::ranges::lower_bound(legs, time_s, {}, &FeedLeg::until_s);
  return leg == legs.end() ? legs.back().motion : leg->motion;
}

/// From its steady motion to rest at an angle.
void Brake(std::vector<FeedLeg>& legs, double at_rad, double ramp_s, double stays_s) {
  const double time_s = legs.back().until_s;
  const CircleMotion before = legs.back().motion;
  if (before.rate_rad_s() != 0.0) legs.push_back({before.RampTo(0.0, time_s, ramp_s), time_s + ramp_s});
  const double stands_s = legs.back().until_s;
  legs.push_back({CircleMotion(before.radius_m(), at_rad, 0.0, stands_s), stands_s + stays_s});
}

/// From rest into steady motion, as far as where it brakes; over all it takes as long as at `rate_rad_s`.
void GoTo(std::vector<FeedLeg>& legs, double to_rad, double rate_rad_s, double ramp_s) {
  const double time_s = legs.back().until_s;
  const CircleMotion before = legs.back().motion;
  const double way_rad = to_rad - before.Angle_rad(time_s);
  const double steady_s = std::max(std::abs(way_rad) / rate_rad_s - ramp_s, ramp_s);
  const double goes_rad_s = way_rad / steady_s;  // both ramps together are as much way as one at full speed
  if (goes_rad_s == 0.0) return;
  legs.push_back({before.RampTo(goes_rad_s, time_s, ramp_s), time_s + ramp_s});
  const double runs_s = legs.back().until_s;
  legs.push_back({CircleMotion(before.radius_m(), legs.back().motion.Angle_rad(runs_s), goes_rad_s, runs_s),
                  runs_s + std::max(0.0, steady_s - ramp_s)});
}

}  // namespace

CircleBodies::CircleBodies(const CircularSettings& settings, const std::vector<CirclePlace>& places)
    : settings_(settings), places_(places) {
  for (std::size_t first = 0, end = 0; first < places.size(); first = end) {
    for (end = first + 1; end < places.size() && SamePass(places[end - 1], places[end]);) ++end;
    places[first].at.feed_m_s > 0.0 ? AddSweep(places, first, end) : AddStops(places, first, end);
  }
}

void CircleBodies::AddSweep(const std::vector<CirclePlace>& places, std::size_t first, std::size_t end) {
  const CircleInstant& at = places[first].at;
  const double rate_rad_s = at.Rate_rad_s(), from_rad = LeadIn_rad(at.commanded_rad, at.direction);
  for (std::size_t i = first; i < end; ++i) {
    const CircleInstant& read = places[i].at;
    taken_.push_back(
        {passes_.size(), (read.commanded_rad - from_rad) / rate_rad_s, read.radius_m, read.commanded_rad});
  }
  Run({{{CircleMotion(at.radius_m, from_rad, rate_rad_s, 0.0), taken_.back().time_s + kBehind_s}}, {}});
}

void CircleBodies::AddStops(const std::vector<CirclePlace>& places, std::size_t first, std::size_t end) {
  const CircularProcedureSettings& s = settings_.procedure;
  const CircleInstant& at = places[first].at;
  const double radius_m = at.radius_m, rate_rad_s = at.direction * s.rapid_m_s / radius_m;
  const double step_rad = at.direction * units::turn / std::max(s.stops, 4);
  const double ramp_s = settings_.drives.ramp_s;
  const double first_rad = at.commanded_rad - step_rad;  // where it stands before it goes to the first
  const double brakes_rad = first_rad - 0.5 * rate_rad_s * ramp_s, from_rad = LeadIn_rad(brakes_rad, at.direction);
  const CircleMotion lead_in(radius_m, from_rad, rate_rad_s, 0.0);
  Pass pass{{{lead_in, (brakes_rad - from_rad) / rate_rad_s}}, {}};
  Brake(pass.legs, first_rad, ramp_s, s.dwell_s);
  for (std::size_t i = first; i < end; ++i) {
    const CircleInstant& read = places[i].at;
    GoTo(pass.legs, read.commanded_rad, s.rapid_m_s / radius_m, ramp_s);
    Brake(pass.legs, read.commanded_rad, ramp_s, s.dwell_s);
    taken_.push_back({passes_.size(), pass.legs.back().until_s, read.radius_m, read.commanded_rad});
  }
  pass.legs.back().until_s += kBehind_s;
  Run(std::move(pass));
}

void CircleBodies::Run(Pass pass) {
  for (std::size_t k = 0; k < kCircleAxes.size(); ++k) {
    mechanics::FeedDrive drive = DriveOf(settings_, k);
    drive.Begin(pass.legs.front().motion);
    pass.axes.emplace_back(drive, kCircleAxes[k], pass.legs);
  }
  passes_.push_back(std::move(pass));
}

double CircleBodies::Position_m(std::size_t reading, std::size_t axis, double before_s) const {
  const Taken& taken = taken_[reading];
  const Pass& pass = passes_[taken.pass];
  const double time_s = taken.time_s - before_s;
  const auto commanded_m = [&](double at_s) { return MotionAt(pass.legs, at_s).At(kCircleAxes[axis], at_s).m; };
  // Records round radius and angle of a reading; its own count.
  const double own_m = taken.radius_m * (axis == 0 ? std::cos(taken.commanded_rad) : std::sin(taken.commanded_rad));
  try {
    return own_m + (commanded_m(time_s) - commanded_m(taken.time_s)) + pass.axes[axis].Off_m(time_s);
  } catch (const std::invalid_argument&) {
    throw InputError("a reading", "its latency reaches out of its pass",
                     "at most half a circle of the motion, or 3 s");
  }
}

bool CircleBodies::AreOf(const CircularSettings& s, const std::vector<CirclePlace>& places) const {
  return s.mechanics.fidelity == settings_.mechanics.fidelity && s.drives == settings_.drives &&
         s.procedure.rapid_m_s == settings_.procedure.rapid_m_s &&
         s.procedure.dwell_s == settings_.procedure.dwell_s && s.procedure.stops == settings_.procedure.stops &&
         places == places_;
}

std::shared_ptr<const CircleBodies> BodiesOnce::Of(const CircularSettings& settings,
                                                   const std::vector<CirclePlace>& places) {
  if (!settings.mechanics.HasBodies()) return nullptr;
  const std::scoped_lock lock(mutex_);
  if (!last_ || !last_->AreOf(settings, places)) last_ = std::make_shared<const CircleBodies>(settings, places);
  return last_;
}

DrivesInClosedForm InClosedForm(const FeedDrivesSettings& drives) {
  DrivesInClosedForm form;
  for (std::size_t k = 0; k < kCircleAxes.size(); ++k) {
    const mechanics::FeedDriveParameters p = ParametersOf(drives, k);
    form.lag_s[k] = p.Lag_s();
    form.backlash_m[k] = p.LostMotion_m();
  }
  return form;
}

}  // namespace twinbench::sim
