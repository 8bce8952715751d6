#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "mechanics/angle_harmonic.h"
#include "mechanics/plant.h"
#include "mechanics/stack.h"

/// Transmission chain of a gear hobbing machine: hob spindle and worktable, coupled by an electronic gearbox.
///
///   hob motor -> machine's hob encoder -> drive of the spindle (errors) -> hob
///                       |
///              x ratio, servo (lag) -> motor with worm -> worm wheel (errors, backlash) -> torsion -> table
///
/// The machine's encoders sit on the motors, so that no servo sees the errors of the gears. Transmission error
/// everywhere: e_T = table - ratio x hob.
namespace twinbench::mechanics {

/// Periodic errors of the gears, each as what it adds to e_T [rad at the table]. The angle that a harmonic counts
/// is that of the part which makes it; those of wheel and worm as the motor turns them. Their difference from the
/// table's own angle, by errors and wind-up, matters in the second order only.
struct GearErrors {
  std::vector<AngleHarmonic> worm_wheel = {};  // order 1: once a turn of the table
  std::vector<AngleHarmonic> worm = {};        // order 1: once a turn of the worm
  std::vector<AngleHarmonic> tooth_mesh = {};  // order 1: once a tooth of the worm wheel
  std::vector<AngleHarmonic> hob_drive = {};   // order 1: once a turn of the hob; of the spindle behind its encoder
  std::vector<AngleHarmonic> hob_encoder =
      {};  // the same, of the machine's encoder: goes through the table's servo
};

struct DriveParameters {
  double inertia_kg_m2 = 0.0;
  double servo_Hz = 20.0;
  double feed_forward = 0.0;  // of the speed; 0: lags by speed / (2 pi servo_Hz), 1: does not
};

/// Defaults: a machine for gears of some hundred millimetres, its ratio that of a hob of 2 starts for 44 teeth. All
/// assumed, not data of a real machine.
struct GearTrainParameters {
  double ratio = 2.0 / 44.0;  // turns of the table for one of the hob; its sign is the sense
  int worm_wheel_teeth = 90;
  int worm_starts = 1;
  DriveParameters hob = {0.5, 20.0, 0.0};
  DriveParameters motor = {0.02, 20.0, 0.0};  // of the table, with the worm
  double table_inertia_kg_m2 = 20.0;
  double stiffness_Nm_rad = 5e6;                        // torsion between worm wheel and table
  double damping_ratio = 0.03;                          // of that torsion with the table's inertia
  double backlash_rad = 0.0;                            // of the worm, full width at the table
  FrictionParameters friction = {.coulomb_Nm = 100.0};  // on the table; keeps the flanks of the worm together
  GearErrors errors;
  /// What the electronic gearbox adds to the table's angle that it commands, and the slope, by that angle. Empty:
  /// nothing. The servo has to follow it.
  std::function<AngleSeries(double table_rad)> correction;
  double servo_period_s = 1e-3;
  double step_s = 1e-3;  // longest sub-step; shortened to divide the servo period and to be stable

  /// Turns of the worm for one of the table.
  double WormRatio() const { return static_cast<double>(worm_wheel_teeth) / worm_starts; }
};

/// @throws std::invalid_argument unless inertias, stiffness, bandwidths, times, teeth and starts are positive, the
///         ratio is not zero, feed-forwards are between 0 and 1, the rest is not negative, all is finite, errors
///         leave the gears turning forwards (sum of order at the table x amplitude below a half), and the servo
///         period is at most 1/40 of 1/servo_Hz of both drives, where their loops are stable.
void Check(const GearTrainParameters& parameters);

/// Angles unwrapped and counter-clockwise, at the start zero but for the gears' errors.
struct GearTrainState {
  double time_s = 0.0;
  double hob_rad = 0.0;  // end of the spindle
  double hob_rad_s = 0.0;
  double table_rad = 0.0;
  double table_rad_s = 0.0;
  double wheel_rad = 0.0;  // where the worm holds the wheel, in the middle of its play: wheel - table is wind-up
  double wheel_rad_s = 0.0;
};

/// State between two states by cubic Hermite polynomials. Its error is h^4/384 times the fourth derivative: at a
/// line of 10 Hz and 1 ms, 4e-8 of its amplitude.
GearTrainState Between(const GearTrainState& before, const GearTrainState& after, double time_s);

/// When the table passes `table_rad` on the way from `before` to `after`, which must be near enough for it to pass
/// once: for counters that are triggered by edges of the table's encoder. Nothing if it does not; an angle that
/// equals that of `before` belongs to the piece before, so that pieces that follow one another find it once.
std::optional<double> PassingTime_s(const GearTrainState& before, const GearTrainState& after, double table_rad);

/// Two fidelities stand behind one face:
///
///   kinematic  quasi-static: exact ratio, errors of the gears, lag by (1 - feed forward) speed / (2 pi servo_Hz),
///              backlash and wind-up (Coulomb torque / stiffness) as one play between worm wheel and table.
///              Neglects inertia: what the servo and the torsion do to harmonics, and transients. Costs nothing at
///              constant speed, however long.
///   bullet     the three bodies by Bullet's dynamics with servos, torsion, backlash and friction.
///
/// A train knows no clock: who owns it says how far time has come. Equal calls give equal bits, in whatever pieces
/// (of whole nanoseconds) the time is told. One instance a thread.
class GearTrain {
 public:
  virtual ~GearTrain() = default;

  /// The hob goes over to another speed; negative turns it clockwise. Begins now; the bullet fidelity sees it at
  /// its next servo period.
  /// @throws std::invalid_argument unless the speed is finite and the ramp positive.
  virtual void Run(double hob_speed_rad_s, double ramp_s) = 0;

  /// Lets time pass; any non-negative amount, rounded to a nanosecond.
  /// @throws std::invalid_argument for a negative one.
  virtual void Advance(double dt_s) = 0;

  virtual GearTrainState State() const = 0;
};

/// @throws std::invalid_argument if Check(parameters) does, or for Fidelity::kLinear, which there is not.
std::unique_ptr<GearTrain> MakeGearTrain(Fidelity fidelity, const GearTrainParameters& parameters);

}  // namespace twinbench::mechanics
