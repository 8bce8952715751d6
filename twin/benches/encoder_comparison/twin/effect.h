#pragma once

#include <memory>

#include "mechanics/encoder_signal.h"
#include "twin/core/reading.h"
#include "twin/core/time.h"
#include "twin/sim/effect_makers.h"

namespace twinbench::sim {

/// What the twin of an angle comparison knows at the instant of a reading.
struct AngleMoment {
  Time now{};
  int setup = 0;
  int reading = 0;
  double shaft_rad = 0.0;       // true angle of the shaft, unwrapped
  double velocity_rad_s = 0.0;  // of the shaft
  double approach_rad = 0.0;    // last leg of the usual way to a stop, signed; 0 in motion
  double above_K = 0.0;         // of the room, above that of the reference, as far as it is known
  int goes = 0;                 // sense of the motion, 0 at rest
  double gains_rad_s2 = kNaN;   // acceleration, where the reading before does not tell it; NaN: it does
  // Where it was that is read, and how it moved there: earlier if the reading is late; told to ShaftError_rad alone.
  double read_rad = 0.0, acceleration_rad_s2 = 0.0;
};

using mechanics::SignalState;

/// One cause on the bench encoder_comparison. Errors, and ages, of different effects add; no effect looks at
/// another one.
class AngleEffect {
 public:
  virtual ~AngleEffect() = default;

  /// Once before each reading, with the time running forwards.
  virtual void Advance(const AngleMoment& /*moment*/) {}
  /// Of the device's shaft, against that of the reference.
  virtual double ShaftError_rad(const AngleMoment& /*moment*/) const { return 0.0; }
  /// Of the device's reading, beyond that of the reference's.
  virtual double Age_s(const AngleMoment& /*moment*/) const { return 0.0; }
  /// Of what is read, beside where the shaft is: a device that follows it.
  virtual double Behind_rad(const AngleMoment& /*moment*/) const { return 0.0; }
  virtual void AlterSignals(SignalState& /*signals*/) const {}
  /// By how much the device's sine rises later than the scenario says.
  virtual double SignalZero_rad() const { return 0.0; }
  /// Of the reading; `device_rad` is the angle of the device's scale.
  virtual double DeviceError_rad(const AngleMoment& /*moment*/, double /*device_rad*/) const { return 0.0; }
  /// Of what the reference shows.
  virtual double ReferenceError_rad(const AngleMoment& /*moment*/) const { return 0.0; }
};

using AngleMakers = EffectMakers<AngleEffect>;
AngleMakers ShaftEffects();    // of where the shaft is, and when it is read
AngleMakers ReadingEffects();  // of what is shown. @throws InputError if the scenario lacks what the effect needs

}  // namespace twinbench::sim
