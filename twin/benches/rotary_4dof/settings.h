#pragma once

#include <array>
#include <string>
#include <vector>

#include "twin/core/frames.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/core/time.h"

/// What a scenario of the bench rotary_4dof says; the defaults are the reference bench of formats.md.
namespace twinbench {

struct LaserSettings {                      // [laser]
  double wavelength_m = 650.0 * units::nm;  // in air
  double power_W = 5.0 * units::mW;
  Vector3 position_m{0.0, 0.2, 0.0};          // in L
  double yaw_rad = 0.0;                       // pointing error of the beam about z ...
  double pitch_rad = 0.0;                     // ... and upwards; it shines along -y
  std::string beam = "chief_ray";             // chief_ray | gaussian | profile
  double beam_radius_m = 0.5 * units::mm;     // 1/e^2 of the irradiance, at the waist (= laser exit)
  double divergence_rad = 0.5 * units::mrad;  // 1/e^2 half angle
  std::string profile_file;                   // OpenEXR of the measured beam, for the beam "profile";
                                              // absolute once loaded
  double wavelength_per_kelvin_m = 0.0;       // against environment.reference_degC
  double mode_hop_K = 0.0;                    // the diode goes to its next mode whenever it is so much warmer;
  double mode_spacing_m = 0.25 * units::nm;   // 0: it never hops
  double post_growth_m_K = 0.0;               // of its height in L
  double pointing_yaw_per_kelvin_rad = 0.0;
  double pointing_pitch_per_kelvin_rad = 0.0;
  double rin_dB_Hz = 0.0;          // relative intensity noise, white; 0: none
  double power_drift_per_s = 0.0;  // of its power, relative
};

struct GratingSettings {  // [grating]
  double lines_per_m = 600e3;
  double width_m = 25.0 * units::mm;  // across the grooves
  double height_m = 25.0 * units::mm;
  /// Relative power of orders -2..+2 (scalar lamellar grating of phase depth pi would be {0, .405, 0, .405, 0}).
  std::array<double, 5> efficiency = {0.1, 0.339, 0.1, 0.339, 0.1};
  std::string efficiency_file;         // the same by incidence: CSV of sin_incidence, m-2, m-1, m0, m+1,
                                       // m+2; absolute once loaded
  Vector3 point_m{0.0, 0.030, 0.050};  // of the spot, from the reference table's origin
  double expansion_per_K = 0.0;        // of the distance of its grooves
  double speckle_m = 0.0;              // by which speckle moves a spot along each axis, root mean square ...
  double speckle_correlation_rad = 130.0 * units::arcsec;  // ... and after which turn by 1/e of it only is the same
  double sphere_m = 0.0;                                   // its front at half its width above its middle
  double astigmatism_m = 0.0;                              // the same along x and as much lower along z
  double ruling_chirp_per_m = 0.0;                         // relative growth of the grooves' distance along x ...
  double ruling_fan_rad_m = 0.0;                           // ... and turn of the grooves along x
  std::string flatness_file;                               // OpenEXR of its front's height; absolute once loaded
  std::string ruling_file;  // OpenEXR of how far the grooves lie from where they should, towards +x
};

/// How the light is found. Known to the twin only, not to the estimators.
struct LightSettings {              // [optics]
  std::string fidelity = "traced";  // traced | closed
  int profile_rays = 16384;         // traced: places of a measured beam that are told apart
  double wander_rad = 0.0;          // of light on a metre of moving air: displacement over length, rms
  double wander_corner_Hz = 100.0;  // wind over the beam's diameter
};

struct PsdSettings {          // [psd_a], [psd_b]
  double distance_m = 0.120;  // spot on the grating -> centre
  double roll_rad = 0.0;      // about the nominal order, right-handed towards the light
  double tilt_u_rad = 0.0;    // about its u axis
  double tilt_v_rad = 0.0;    // about its v axis
  double sensitivity_V_m = 2000.0;
  double width_m = 10.0 * units::mm;
  double height_m = 10.0 * units::mm;
  double cubic_per_m2 = 0.0;    // u -> u (1 + cubic r^2), electrode non-linearity
  double stray_fraction = 0.0;  // uniform stray light / signal
  bool window = false;
  double window_thickness_m = 1.0 * units::mm;
  double window_index = 1.51;
  double window_gap_m = 1.0 * units::mm;  // window back -> silicon
  double window_reflectance = 0.042;      // of one surface
  double window_wedge_rad = 0.0;
  bool window_coherent = false;      // interference between the window's faces (etalon)
  double silicon_reflectance = 0.0;  // > 0 switches the PSD -> grating -> PSD ghosts on
  double responsivity_A_W = 0.45;    // silicon in red light
  double dark_current_A = 10.0e-9;
  double background_A = 0.0;               // that the read-out takes for signal: light of the room
  double electrode_resistance_ohm = 10e3;  // between the two electrodes of an axis
  double distance_expansion_per_K = 0.0;   // of what holds it at its distance
  double post_growth_m_K = 0.0;            // of its height in L
  double bandwidth_Hz = 100e3;             // of the read-out; with it the light's own noise grows
};

struct ProcedureSettings {  // [procedure]
  std::vector<std::string> phases = {"calibration",
                                     "full_circle"};  // of calibration, stability, verification, full_circle
  int positions = 36;
  std::vector<int> shifts = {0, 1, 7, 11};   // in steps
  std::vector<int> passes = {1, -1, -1, 1};  // directions
  std::string clamping = "reseat";           // reclamp | reseat
  std::vector<double> dwell_s = {1.0};       // drawn at random from this list at every stop
  double run_up_steps = 0.5;                 // every pass approaches its first stop from this far behind
  double remount_s = 600.0;                  // time a set-up takes
  double sweep_rad = 300.0 * units::arcsec;  // calibration: +- this, in yaw and in tilt
  int sweep_points = 13;
  double stability_s = 3600.0;
  double stability_interval_s = 10.0;
  int verification_points = 7;  // within the sweep, at angles the calibration did not use
  bool keep_raw = false;
};

/// What a newcomer gets: bodies by Bullet, on the floor of a quiet laboratory.
inline MechanicsSettings BodiesOnAQuietFloor() {
  MechanicsSettings mechanics;
  mechanics.fidelity = "bullet";
  mechanics.vibration = "auto";
  return mechanics;
}

/// Keys of [amplifier] and [adc] that this bench alone has.
struct ChainSettings {
  double low_pass_Hz = 0.0;  // amplifier.low_pass: of one pole; 0: none
  double dnl_lsb = 0.0;      // adc.dnl: differential non-linearity, root mean square
  std::string dnl_file;      // adc.dnl_file: as it was measured, by code; absolute once loaded
};

/// [probes]: displacement probes at an artefact on the target, in the place of grating and PSDs. Only recordings of
/// others have them.
struct ProbeSettings {
  std::vector<double> angles_rad = {0.0, 0.25 * units::turn};  // of the radial ones, counter-clockwise
  int reversed_mounting = -1;  // where artefact and probes were turned by half a turn (Donaldson); -1: none
};

struct RotarySettings {
  LaserSettings laser;
  GratingSettings grating;
  LightSettings optics;
  PsdSettings psd_a;
  PsdSettings psd_b;
  AmplifierSettings amplifier;
  AdcSettings adc;
  ChainSettings chain;
  TableSettings target;
  TableSettings reference;
  double reference_height_m = 0.080;                     // [reference] height_mm: its origin above the target's
  Eigen::Vector2d centring_m = Eigen::Vector2d::Zero();  // [reference] centring_um: its body on the target rotor
  Eigen::Vector2d mount_tilt_rad = Eigen::Vector2d::Zero();  // [reference] mount_tilt_arcsec: about x and y
  MechanicsSettings mechanics = BodiesOnAQuietFloor();
  AutocollimatorSettings autocollimator;
  ProbeSettings probes;
  ProcedureSettings procedure;
};

/// The bench's own part of a scenario. @throws std::logic_error if it is another bench's.
inline RotarySettings& RotaryOf(Scenario& scenario) {
  return scenario.own.As<RotarySettings>();
}
inline const RotarySettings& RotaryOf(const Scenario& scenario) {
  return scenario.own.As<RotarySettings>();
}

// A reading of the rotary bench is the mean of a block of the A/D converter: it tells of the middle of the block,
// and `time_s` is its begin.

inline Duration BlockTime(const AdcSettings& adc, int n_samples) {
  return FromSeconds(static_cast<double>(n_samples) * kChannels / adc.rate_Hz);
}

/// Scans of its block; those of the scenario where the record does not say.
inline int SamplesOf(const Reading& reading, const AdcSettings& adc) {
  return reading.n_samples > 0 ? reading.n_samples : adc.samples;
}

inline std::vector<Reading> AtMiddleOfBlocks(std::vector<Reading> readings, const AdcSettings& adc) {
  for (Reading& reading : readings) reading.time += BlockTime(adc, SamplesOf(reading, adc)) / 2;
  return readings;
}

}  // namespace twinbench
