#include "mechanics/feed_parameters.h"

#include <cmath>
#include <numbers>

#include "mechanics/require.h"

namespace twinbench::mechanics {
namespace {

void CheckFriction(const FeedFriction& f) {
  RequireNotNegative(f.coulomb_N, "feed drive: friction.coulomb_N");
  RequireNotNegative(f.viscous_N_s_m, "feed drive: friction.viscous_N_s_m");
  RequirePositive(f.stribeck_m_s, "feed drive: friction.stribeck_m_s");
  RequirePositive(f.presliding_m, "feed drive: friction.presliding_m");
  RequireNotNegative(f.bristle_damping_ratio, "feed drive: friction.bristle_damping_ratio");
  Require(f.static_ratio >= 1.0 && std::isfinite(f.static_ratio),
          "feed drive: friction.static_ratio must be at least 1");
}

void CheckServo(const FeedDriveParameters& p) {
  RequirePositive(p.position_gain_1_s, "feed drive: position_gain_1_s");
  RequirePositive(p.velocity_gain_1_s, "feed drive: velocity_gain_1_s");
  RequirePositive(p.integral_time_s, "feed drive: integral_time_s");
  RequirePositive(p.servo_period_s, "feed drive: servo_period_s");
  RequirePositive(p.step_s, "feed drive: step_s");
  Require(p.feed_forward >= 0.0 && p.feed_forward <= 1.0, "feed drive: feed_forward must be between 0 and 1");
  Require(p.velocity_gain_1_s * p.servo_period_s <= 0.5,
          "feed drive: velocity_gain_1_s must be at most 0.5 / servo_period_s");
}

}  // namespace

double FeedDriveParameters::Transmission_m() const {
  return lead_m / (2.0 * std::numbers::pi);
}

double FeedDriveParameters::ScrewMass_kg() const {
  return screw_inertia_kg_m2 / (Transmission_m() * Transmission_m());
}

double FeedDriveParameters::Stiffness_N_m() const {
  const double r_m = Transmission_m();
  return 1.0 / (1.0 / axial_stiffness_N_m + r_m * r_m / torsional_stiffness_Nm_rad);
}

double FeedDriveParameters::Damping_N_s_m() const {
  const double reduced_kg = mass_kg * ScrewMass_kg() / MovedMass_kg();
  return 2.0 * damping_ratio * std::sqrt(Stiffness_N_m() * reduced_kg);
}

double FeedDriveParameters::LostMotion_m() const {
  return encoder == FeedEncoder::kSlide ? 0.0 : play_m + 2.0 * friction.coulomb_N / Stiffness_N_m();
}

BristleLaw FeedDriveParameters::Law() const {
  BristleLaw law{friction.coulomb_N, friction.static_ratio, friction.stribeck_m_s, friction.presliding_m, 0.0};
  law.damping = 2.0 * friction.bristle_damping_ratio * std::sqrt(law.Stiffness() * mass_kg);
  return law;
}

PositionLoop FeedDriveParameters::Loop() const {
  const double proportional_Nm_s = velocity_gain_1_s * MovedMass_kg() * Transmission_m() * Transmission_m();
  return {{position_gain_1_s, feed_forward, proportional_Nm_s, proportional_Nm_s / integral_time_s},
          servo_period_s};
}

void Check(const FeedDriveParameters& p) {
  RequirePositive(p.mass_kg, "feed drive: mass_kg");
  RequirePositive(p.screw_inertia_kg_m2, "feed drive: screw_inertia_kg_m2");
  RequirePositive(p.lead_m, "feed drive: lead_m");
  RequirePositive(p.axial_stiffness_N_m, "feed drive: axial_stiffness_N_m");
  RequirePositive(p.torsional_stiffness_Nm_rad, "feed drive: torsional_stiffness_Nm_rad");
  RequireNotNegative(p.damping_ratio, "feed drive: damping_ratio");
  RequireNotNegative(p.play_m, "feed drive: play_m");
  CheckFriction(p.friction);
  CheckServo(p);
  Require(p.play_m == 0.0 || p.friction.coulomb_N > 0.0,
          "feed drive: play_m needs friction.coulomb_N, without it the slide would float in its play");
}

}  // namespace twinbench::mechanics
