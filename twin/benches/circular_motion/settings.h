#pragma once

#include <array>
#include <string>
#include <vector>

#include "twin/core/scenario.h"

/// What a scenario of the bench circular_motion says. Pairs are x, y.
namespace twinbench {

using AxisPair = std::array<double, 2>;

/// The linear axes; errors are actual minus commanded.
struct CircularMachineSettings {      // [machine]
  AxisPair lag_s = {1e-3, 1e-3};      // of the servo: an axis answers 1 / (1 + lag s) ...
  std::string lag_kind = "first_order";  // ... or is late by that time: first_order | fixed_delay
  AxisPair scale = {};                // positioning error per length
  double squareness_rad = 0.0;        // the angle from +X to +Y is 90 deg + this
  AxisPair bow_m = {};                // [machine] straightness: P2 along the other axis ...
  AxisPair s_shape_m = {};            // ... and straightness3: P3
  double span_m = 200.0 * units::mm;  // half the travel over which these are stated
  AxisPair backlash_m = {};
  AxisPair spike_m = {};      // largest excursion behind a reversal ...
  double spike_time_s = 0.5;  // ... this long behind it
  AxisPair cyclic_m = {};
  AxisPair cyclic_phase_rad = {};
  double cyclic_pitch_m = 10.0 * units::mm;
  AxisPair expansion_per_K = {};     // of the scales
  AxisPair drift_m_per_K = {};       // of the spindle against the table
  double noise_m = 0.2 * units::um;  // repeatability, an axis and reading, standard deviation
};

struct CircularMechanicsSettings {     // [mechanics]
  std::string fidelity = "kinematic";  // kinematic | linear | bullet

  /// Whether the axes are bodies with drives; else they follow in closed form.
  bool HasBodies() const { return fidelity != "kinematic"; }
};

/// Drives of the linear axes where they are bodies. A plausible small machining centre, not data of a real machine.
struct FeedDrivesSettings {  // [drives]
  AxisPair mass_kg = {300.0, 300.0};
  AxisPair screw_inertia_kg_m2 = {4e-3, 4e-3};
  AxisPair lead_m = {10.0 * units::mm, 10.0 * units::mm};
  AxisPair stiffness_N_m = {150e6, 150e6};
  AxisPair torsion_Nm_rad = {8000.0, 8000.0};
  double damping_ratio = 0.05;
  AxisPair play_m = {};
  AxisPair friction_N = {200.0, 200.0};
  AxisPair viscous_N_s_m = {2000.0, 2000.0};
  double static_ratio = 1.3;
  double stribeck_m_s = 2.0 * units::mm;
  double presliding_m = 5.0 * units::um;
  AxisPair position_gain_1_s = {50.0, 50.0};
  AxisPair velocity_gain_1_s = {300.0, 300.0};
  AxisPair integral_time_s = {0.02, 0.02};
  AxisPair feed_forward = {0.95, 0.95};
  std::string encoder = "motor";  // motor | slide
  double ramp_s = 1.0;            // of the path's speed, at both ends of a way to a stop
  double servo_period_s = 500.0 * units::us;
  double step_s = 500.0 * units::us;

  friend bool operator==(const FeedDrivesSettings&, const FeedDrivesSettings&) = default;
};

struct BarSettings {  // [bar]
  double noise_m = 0.15 * units::um;
  double resolution_m = 0.1 * units::um;
  AxisPair offset_m = {};       // commanded centre as seen from ball 1
  double height_m = 0.0;        // ball 2 above ball 1
  double length_error_m = 0.0;  // bar longer than the commanded radius where it shows zero
  double gain_error = 0.0;
  double cubic_per_m2 = 0.0;
  AxisPair ball_m = {};  // [bar] ball2, ball3: form of ball 1, two and three times a turn
  AxisPair ball_azimuth_rad = {};
  double expansion_per_K = 0.0;
  double latency_s = 0.0;
};

struct BarEncoderSettings {  // [encoder], at ball 1
  double noise_rad = 0.1 * units::arcsec;
  int lines = 18000;
  int interpolation = 4096;
  double zero_rad = 0.0;
  AxisPair tilt_rad = {};  // of its axis about X and Y
  double eccentricity_rad = 0.0;
  double eccentricity_azimuth_rad = 0.0;
  double ellipticity_rad = 0.0;
  double ellipticity_azimuth_rad = 0.0;
  double latency_s = 0.0;
};

struct GridSettings {  // [grid]
  double noise_m = 0.05 * units::um;
  double period_m = 4.0 * units::um;
  double rotation_rad = 0.0;
  AxisPair scale = {};
  double shear_rad = 0.0;
  AxisPair offset_m = {};
  double sde_m = 0.0;  // subdivisional error, amplitude
};

/// Half width of what every set-up draws anew; free in every estimate. A bar without an encoder is set to length before it
/// is used: none is drawn.
struct CircularMountingSettings {  // [mounting]
  double offset_m = 50.0 * units::um;
  double zero_rad = 0.05 * units::deg;
  double length_m = 10.0 * units::um;
  double grid_rotation_rad = 200.0 * units::arcsec;
};

struct CircularSetup {
  std::string instrument = "bar";  // bar | radial_bar | grid | drive
  double radius_m = 110.230 * units::mm;

  bool IsDrive() const { return instrument == "drive"; }  // the controller's own scales: nothing is mounted
  bool IsBar() const { return instrument != "grid" && !IsDrive(); }
  bool ShowsAngle() const { return instrument != "radial_bar"; }  // else the radius alone
};

struct CircularProcedureSettings {  // [circular_procedure]
  std::vector<CircularSetup> setups = {
      {"bar", 110.230 * units::mm}, {"bar", 156.278 * units::mm}, {"grid", 110.230 * units::mm}};
  std::vector<double> feeds_m_s = {40.0 * (units::mm / 60.0), 1000.0 * (units::mm / 60.0)};
  int points = 240;  // a turn in motion
  int stops = 36;    // a turn at rest; 0: none
  double dwell_s = 3.0;
  double rapid_m_s = 500.0 * units::mm / 60.0;  // from stop to stop
  std::vector<int> directions = {1, -1};
  double start_rad = 0.0;
  double remount_s = 900.0;  // time a set-up takes
};

struct CircularSettings {
  CircularMachineSettings machine;
  CircularMechanicsSettings mechanics;
  FeedDrivesSettings drives;
  BarSettings bar;
  BarEncoderSettings encoder;
  GridSettings grid;
  CircularMountingSettings mounting;
  CircularProcedureSettings procedure;
};

/// Standard deviation of one reading as the scenario states it: of the instrument, its quantum, and the machine.
struct StatedNoise {
  double radial_m, tangential_m;
  double radial_steps_m = 0.0, tangential_steps_m = 0.0;  // of it, of the instrument's quantum
};
StatedNoise StatedNoiseOf(const CircularSettings& settings, bool is_bar, double radius_m);

/// The bench's own part of a scenario. @throws std::logic_error if it is another bench's.
inline CircularSettings& CircularOf(Scenario& scenario) {
  return scenario.own.As<CircularSettings>();
}
inline const CircularSettings& CircularOf(const Scenario& scenario) {
  return scenario.own.As<CircularSettings>();
}

}  // namespace twinbench
