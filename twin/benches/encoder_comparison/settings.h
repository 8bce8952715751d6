#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "twin/core/scenario.h"

/// What a scenario of the bench encoder_comparison says.
namespace twinbench {

/// The angle device under test.
struct DeviceSettings {                   // [device]
  double noise_rad = 0.002 * units::deg;  // one reading, white, standard deviation
  bool noise_known = false;               // false: whoever evaluates readings estimates it from them
  double resolution_rad = 0.0;            // least step of the reading; 0: none
  double turn_m = 0.0;           // [device] turn_mm of a linear axis: the way that counts as one turn; 0: it turns
  int lines = 0;                 // [device] lines_per_turn; 0: not known
  int teeth = 0;                 // of a gear between reference and device; 0: none known
  double stamp_noise_s = 2e-9;   // of the time at which a line passes, standard deviation
  int signal_periods = 1;        // of its sine and cosine signals a turn
  double signal_zero_rad = 0.0;  // angle of the device at which the sine signal rises through zero
  bool signal_zero_known = false;  // false: the evaluation leaves the phase of signal faults free
  // Of its scale: drawn with the bench (seed), the same in all its runs; the size of order k falls as k^-fall.
  double graduation_rad = 0.0;  // root mean square of the curve; 0: none
  double graduation_fall = 1.0;
  int graduation_orders = 64;
};

struct EncoderProcedureSettings {            // [encoder_procedure]
  std::string kind = "stops";                // stops | sweep | coast
  double turns = 2.0;                        // of a pass
  double start_rad = 0.0;                    // where the first pass begins
  std::vector<int> passes = {1, -1, -1, 1};  // directions; a sweep does them at each speed
  std::vector<double> mounting_rad = {0.0};  // device angle where the reference shows 0, one a set-up
  double remount_s = 600.0;                  // time a set-up takes
  std::vector<double> heads_rad = {0.0};     // heads that read the device's ring at once; each is a set-up
  double reference_noise_rad = 0.0;          // of what the reference shows at one instant, the same for all heads
  int stops = 72;                            // stops: [encoder_procedure] stops_per_turn
  double stop_interval_s = 4.0;
  int readings_per_stop = 1;                                                  // stops: their mean is one reading
  double read_s = 0.02;                                                       // stops: that each of them takes
  std::vector<double> speeds_rad_s = {36.0 * units::deg, 12.0 * units::deg};  // sweep
  double ramp_s = 0.6;       // at constant acceleration, up and down
  double rest_s = 2.0;       // behind every pass
  double interval_s = 0.08;  // between readings
  int stamps = 1024;         // coast: lines of a turn whose times are taken

  /// Whose mean one reading is.
  int ReadingsAtOnce() const { return kind == "stops" ? readings_per_stop : 1; }
};

/// A spindle without its drive: phi'' = - s (friction + viscous w + drag w^2 + ripple cos(order phi)) + torque cos(order
/// phi), w the speed's size and s its sign.
struct SpindleSettings {            // [spindle]
  double friction_rad_s2 = 0.0;
  double viscous_per_s = 1.0 / 600.0;
  double drag_per_rad = 0.0;
  double torque_rad_s2 = 0.0;  // of magnets, of an unbalance: the same in both directions
  int torque_order = 12;
  double ripple_rad_s2 = 0.0;  // of the friction: against the motion
  int ripple_order = 3;
};

struct EncoderSettings {
  DeviceSettings device;
  EncoderProcedureSettings encoder_procedure;
  SpindleSettings spindle;
};

/// The device as means of a stop's readings show it: noise and what steps add to it are less by the root of their
/// count.
inline DeviceSettings DeviceOfMeans(const EncoderSettings& s) {
  DeviceSettings device = s.device;
  device.noise_rad /= std::sqrt(s.encoder_procedure.ReadingsAtOnce());
  device.resolution_rad /= std::sqrt(s.encoder_procedure.ReadingsAtOnce());
  return device;
}

/// The bench's own part of a scenario. @throws std::logic_error if it is another bench's.
inline EncoderSettings& EncoderOf(Scenario& scenario) {
  return scenario.own.As<EncoderSettings>();
}
inline const EncoderSettings& EncoderOf(const Scenario& scenario) {
  return scenario.own.As<EncoderSettings>();
}

}  // namespace twinbench
