#pragma once

#include <memory>
#include <string>

#include "mechanics/stack.h"

/// The two tables as something that is told to move and can be looked at. Three fidelities stand behind one face:
///
///   kinematic  rotors follow the profile; bearings are at their static deflection. Costs almost nothing.
///   linear     adds following error, settling and vibration by the linear model (with friction and torque limit as
///              inputs sampled at the servo period).
///   bullet     the whole stack by Bullet's dynamics in sub-steps of a servo period: the reference of the other
///   two.
///
/// A plant knows no clock: who owns it says how far time has come. Equal calls give equal bits, in whatever pieces
/// (of whole nanoseconds) the time is told.
namespace twinbench::mechanics {

enum class Axis { kTarget, kReference };
enum class Fidelity { kKinematic, kLinear, kBullet };

/// @throws std::invalid_argument unless the name is "kinematic", "linear" or "bullet".
Fidelity FidelityFromName(const std::string& name);

/// Angles unwrapped, counter-clockwise seen from above. `encoder` is what the controller reads, `rotor` is where
/// the rotor is without its index error ez (which belongs to the table's ErrorMotion); they differ by the backlash.
struct StackState {
  double target_rad = 0.0;  // rotor
  double reference_rad = 0.0;
  double target_encoder_rad = 0.0;
  double reference_encoder_rad = 0.0;
  BearingPose target_bearing;
  BearingPose reference_bearing;
};

class Plant {
 public:
  virtual ~Plant() = default;

  /// Starts a move along a quintic profile from where the axis was last commanded to be. Moves of both axes that
  /// are started without time passing between run together.
  /// @throws std::logic_error while the axis' last profile still runs; std::invalid_argument for a duration that is
  ///         not positive or an angle that is not finite.
  virtual void StartMove(Axis axis, double to_rad, double duration_s) = 0;

  /// Breaks a running move off: the command comes to rest within kBraking_s. Nothing if none runs.
  virtual void Stop(Axis axis) = 0;
  static constexpr double kBraking_s = 0.2;

  /// Where the axis was last commanded to end up.
  virtual double CommandedEnd_rad(Axis axis) const = 0;

  /// Lets time pass; any non-negative amount, rounded to a nanosecond.
  /// @throws std::invalid_argument for a negative one.
  virtual void Advance(double dt_s) = 0;

  virtual StackState State() const = 0;

  /// True when the axis' profile has ended and its encoder was within 0.01 arcsec of the command for the last 10 ms
  /// (the kinematic plant: at once), whatever the other axis does; whose reaction can push it out again.
  virtual bool Settled(Axis axis) const = 0;

  /// True when both have settled. From then until the next move the plant sleeps and Advance costs nothing.
  bool Settled() const { return Settled(Axis::kTarget) && Settled(Axis::kReference); }

  /// Takes over what a new mounting changes: position of the reference's body and of the grating.
  /// @throws std::logic_error unless settled.
  virtual void Mount(const ChainGeometry& geometry) = 0;

  /// Advances to the end of the profiles and from there in pieces of 1 ms until settled or `limit_s` has passed.
  /// @return the time passed; settled or not is for Settled() to say.
  double AdvanceUntilSettled(double limit_s);

 protected:
  /// Time until the last profile ends; zero if all have.
  virtual double ProfileLeft_s() const = 0;
};

/// @throws std::invalid_argument if Check(parameters) does.
std::unique_ptr<Plant> MakePlant(Fidelity fidelity, const StackParameters& parameters);

}  // namespace twinbench::mechanics
