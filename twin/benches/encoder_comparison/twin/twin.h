#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "twin/benches/encoder_comparison/twin/effect.h"
#include "twin/benches/encoder_comparison/twin/graduation.h"
#include "twin/benches/encoder_comparison/twin/shaft_course.h"
#include "twin/benches/encoder_comparison/twin/spindle.h"
#include "twin/core/devices.h"
#include "twin/core/scenario.h"
#include "twin/model/follow.h"
#include "twin/sim/driven_machine.h"
#include "twin/sim/empirical_signal.h"
#include "twin/sim/environment.h"

namespace twinbench::sim {

/// The virtual angle comparison: an ideal device and an ideal reference on one shaft, with the scenario's effects.
/// A head at b reads the device's ring where a mounting of -b would have it.
///
/// Same scenario, same bits; the noise of a reading follows from its number alone.
class EncoderTwin : public AngleComparator {
 public:
  /// @throws InputError if an effect needs what the scenario does not state.
  explicit EncoderTwin(const Scenario& scenario);
  /// @param run_up_rad  Usual way to a stop in its direction: half the distance of the stops that are followed.
  EncoderTwin(const Scenario& scenario, double run_up_rad);

  void Take(Reading& reading) override;

  /// What the device would show, noise apart, at the instant when the reference showed `reading.reference_rad`.
  /// Readings are asked for in their order.
  /// @param shaft_rad     By how much the shaft stands beside where the reference says.
  /// @param gains_rad_s2  Its acceleration, where the reading before does not tell it.
  double DeviceAt_rad(const Reading& reading, double shaft_rad = 0.0, double gains_rad_s2 = kNaN);

  /// {"device": {"position_deg", "ez_arcsec"}, "reference": same, "effects": [...], "seed": n}: opened only by
  /// tests and scores. Both curves show too much where positive, each by its own angle at every degree, without
  /// their mean.
  nlohmann::json Truth() const;

 private:
  void TakeStamp(Reading& reading);
  double AboveReference_K(Time now);
  void LogTemperature(Reading& reading);
  double MountingOf_rad(int setup) const;
  double Shown_rad(const AngleMoment& moment) const;
  void Advance(const AngleMoment& moment);
  double ShaftAngle_rad(const AngleMoment& moment) const;
  double DeviceError_rad(const AngleMoment& moment, double device_rad) const;
  double ReferenceError_rad(const AngleMoment& moment) const;

  Scenario scenario_;
  double run_up_rad_;
  double signal_zero_rad_;
  Graduation graduation_;
  CoastingSpindle spindle_;
  std::vector<std::unique_ptr<AngleEffect>> effects_;
  ShaftCourse course_;
  SignalState signals_;
  EmpiricalSignal empirical_;
  std::optional<Environment> room_;  // where its temperature changes
};

/// The angle comparison's twin on the course of a record; the prediction is the device's angle where the reference
/// showed what it did [rad], counted on over turns. Points: "shaft" (under both), "device" (of what it shows).
std::unique_ptr<model::Follow> FollowEncoder(const Scenario& scenario, const std::vector<Reading>& record);

/// The shaft of a comparison at stops and what both devices show, for a machine that is driven.
std::unique_ptr<DrivenPhysics> MakeShaftPhysics(const Scenario& scenario);

}  // namespace twinbench::sim
