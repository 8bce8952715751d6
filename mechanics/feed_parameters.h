#pragma once

#include "mechanics/bristles.h"
#include "mechanics/position_loop.h"

/// A linear axis of a machine tool: motor with ball screw, nut, and a slide on its guideway.
namespace twinbench::mechanics {

struct FeedFriction {  // of the guideway, see BristleLaw
  double coulomb_N = 0.0;
  double static_ratio = 1.3;
  double stribeck_m_s = 2e-3;
  double presliding_m = 5e-6;
  double bristle_damping_ratio = 0.3;  // of the bristles against the slide
  double viscous_N_s_m = 0.0;
};

/// What the position controller reads.
enum class FeedEncoder { kMotor, kSlide };

/// Defaults: a plausible small machining centre (assumed, not data of a real machine).
///
/// With r = lead / 2 pi, the nut at r times the screw's angle, u = nut - slide, B the play and v = d slide / dt:
///
///   mass  d2 slide / dt2 = P - friction(v) - viscous v
///   inertia / r^2  d2 nut / dt2 = drive - P
///   P = k (u - B/2) + d du/dt  for u > B/2 and the like at -B/2; flanks push and do not pull; 0 between them
///   1 / k = 1 / axial stiffness + r^2 / torsional stiffness
///   d = 2 damping_ratio sqrt(k m'),  m' the reduced mass of slide and screw
///
/// The control is a cascade, sampled at the servo period (PositionLoop): with e = command - encoder and
/// M = mass + inertia / r^2
///
///   speed wanted = Kv e + feed_forward d command / dt
///   drive = velocity_gain M (error + integral of it / integral_time)
///
/// With a stiff screw and no friction, slide over command is, as far as the period is short and with a, T and f for
/// velocity gain, integral time and feed forward,
///
///   H(s) = (Kv + f s) (s + 1/T) / ((s + Kv) (s + 1/T) + s^3 / a)                                            (F1)
///
/// At constant speed the slide lags by (1 - f) speed / Kv. A step F of the friction, twice its level at a reversal,
/// moves the slide, if a is large and T = 1 / Kv, by
///
///   F / (a M) t exp(-Kv t): at most F / (e Kv a M), 1 / Kv behind the step                                  (F2)
///
/// if the command gets away with an acceleration far above F Kv / (a M); else the slide sticks until the drive's
/// force has turned round, and the spike is lower and later. Seen from the motor it stays behind on either side by
///
///   B/2 + friction / k                                                                                      (F3)
///
/// References: Gross, Hamann, Wiegaertner, Electrical Feed Drives in Automation (2001); Altintas et al., CIRP
/// Annals 60 (2011) 779-796 (cascade, two-mass screw drive); Armstrong-Helouvry et al., Automatica 30 (1994)
/// 1083-1138.
struct FeedDriveParameters {
  double mass_kg = 300.0;
  double screw_inertia_kg_m2 = 4e-3;  // with the motor
  double lead_m = 10e-3;
  double axial_stiffness_N_m = 150e6;        // screw, nut and bearings
  double torsional_stiffness_Nm_rad = 8000;  // screw and coupling
  double damping_ratio = 0.05;
  double play_m = 0.0;  // full width, between nut and slide
  FeedFriction friction;
  double position_gain_1_s = 50.0;   // Kv
  double velocity_gain_1_s = 300.0;  // band of the speed controller
  double integral_time_s = 20e-3;
  double feed_forward = 0.95;
  FeedEncoder encoder = FeedEncoder::kMotor;
  double servo_period_s = 500e-6;
  double step_s = 500e-6;  // of the bodies, longest; shortened to divide the servo period and to be stable

  double Transmission_m() const;  // r
  double ScrewMass_kg() const;    // inertia / r^2
  double MovedMass_kg() const { return mass_kg + ScrewMass_kg(); }
  double Stiffness_N_m() const;  // k
  double Damping_N_s_m() const;  // d
  double Lag_s() const { return (1.0 - feed_forward) / position_gain_1_s; }
  /// Ways by which the slide stays behind at a reversal, full width; 0 where the encoder is on the slide.
  double LostMotion_m() const;
  BristleLaw Law() const;
  /// In the screw's angle.
  PositionLoop Loop() const;
};

/// @throws std::invalid_argument unless all is finite and masses, stiffnesses, gains and times are positive; for a
///         play without Coulomb friction, in which the slide would float; for a velocity gain above 0.5 / period.
void Check(const FeedDriveParameters& parameters);

}  // namespace twinbench::mechanics
