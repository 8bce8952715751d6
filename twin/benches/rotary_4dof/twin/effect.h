#pragma once

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "mechanics/pose_error.h"
#include "twin/core/devices.h"
#include "twin/sim/effect_makers.h"

namespace twinbench::sim {

/// What the twin knows at one instant and an effect may depend on.
struct Moment {
  Time now{};
  Time mounted{};                  // end of the last mounting
  std::array<Time, 2> departed{};  // begin of the last move of target and reference
  Time arrived{};                  // end of the last move of either, which may be still to come
  double averaged_s = 0.0;         // 0: this very instant; else the mean over as long about it is asked for
  double lag_s = 0.0;          // of a pole before the converter, by which `now` is earlier than what is asked for
  double temperature_K = 0.0;  // of the room, above environment.reference_degC
  double target_rad = 0.0;     // rotors, unwrapped, without the index error ez
  double reference_rad = 0.0;
  int target_direction = 1;  // sense of the last move
  int reference_direction = -1;
  /// How far target and reference have come on it.
  std::array<double, 2> travelled_rad = {std::numeric_limits<double>::infinity(),
                                         std::numeric_limits<double>::infinity()};
  int setup = 0;
  int reading = 0;  // running number of the block being taken
};

/// Errors of the kinematic chain that no encoder shows. Zero is the nominal bench.
struct PoseState {
  double target_yaw_rad = 0.0;  // rotor against encoder
  double reference_yaw_rad = 0.0;
  double grating_yaw_rad = 0.0;  // of the grating about the laser spot ...
  double grating_tilt_rad = 0.0;
  double grating_roll_rad = 0.0;
  double grating_shift_m = 0.0;          // ... and along its normal, in L
  mechanics::PoseError target_error;     // beside the tables' own: in L ...
  mechanics::PoseError reference_error;  // ... and in the reference's rotor frame
};

struct LightState {
  double wavelength_m = 0.0;
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double above_K = 0.0;       // what lengths on the way have grown by
  double power_change = 0.0;  // relative, above -1
};

/// How the grating was brought back to the PSDs.
struct Mounting {
  double clamp_rad = 0.0;
  double reseat_rad = 0.0;
  bool body_reseated = true;  // the reference's body was lifted and seated anew; otherwise the grating was
};

/// What the A/D adds between its input and its code.
struct SamplingState {
  std::array<double, kChannels> step_V{};     // added above ...
  std::array<double, kChannels> step_at_V{};  // ... this input voltage
  std::array<double, kChannels> crosstalk{};  // share of the previously converted channel
};

/// One cause. An effect changes the stages it acts on and leaves the others alone; the order of calls within a
/// reading is that of the functions below. Effects may keep state (a lag, a random stream) but never look at
/// another effect.
class Effect {
 public:
  virtual ~Effect() = default;

  /// Before anything is built: constants of the bench that are not what the scenario says.
  virtual void AlterBench(Scenario& /*actual*/) const {}
  /// Period, or time constant, of the fastest thing that it does. An A/D block is looked at as often as that needs.
  virtual double Shortest_s() const { return std::numeric_limits<double>::infinity(); }
  /// Before each look at the bench, be it a block, an autocollimator or a picture, with the time running forwards.
  virtual void Advance(const Moment& /*moment*/) {}
  virtual void AlterMounting(Mounting& /*mounting*/) const {}
  /// The angles at which the tables' scales are read, when they are not those of the rotors.
  virtual void AlterLabels(double& /*target_rad*/, double& /*reference_rad*/) const {}
  virtual void AlterPose(const Moment&, PoseState& /*pose*/) const {}
  virtual void AlterLight(const Moment&, LightState& /*light*/) const {}
  /// What comes to one channel by what all of them show (voltages of the spots alone).
  virtual double AddedToShown_V(const Moment&, const std::array<double, kChannels>& /*signal_V*/,
                                int /*channel*/) const {
    return 0.0;
  }
  /// Voltages at the A/D's input, in the order of the scan list.
  virtual void AlterSignal(const Moment&, std::array<double, kChannels>& /*signal_V*/) {}
  virtual void AlterSampling(SamplingState& /*sampling*/) const {}
  /// After the A/D: wiring and labels.
  virtual void AlterReadout(Acquisition& /*block*/) const {}
};

EffectMakers<Effect> PoseEffects();    // in where things stand and how they move
EffectMakers<Effect> SignalEffects();  // on the way of the light, in the electronics and the wiring

std::unique_ptr<Effect> MakeEmpirical(const EmpiricalSettings& settings, const Scenario& scenario);

}  // namespace twinbench::sim
