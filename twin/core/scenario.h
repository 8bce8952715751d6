#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "twin/core/frames.h"
#include "twin/core/harmonic_settings.h"
#include "twin/core/hob_settings.h"
#include "twin/core/table_errors.h"
#include "twin/core/turntable_settings.h"
#include "twin/core/units.h"

/// A scenario: one measurement on one bench, everything in SI. The structs below are the file format (see
/// settings.cc of each bench for keys, units and bounds); the defaults are the reference rotary bench of
/// formats.md. A key is a field's name with the unit of the file: wavelength_m is `wavelength_nm`.
namespace twinbench {

enum class BeamModel { kChiefRay, kGaussian, kProfile };

struct LaserSettings {                      // [laser]
  double wavelength_m = 650.0 * units::nm;  // in air
  double power_W = 5.0 * units::mW;
  Vector3 position_m{0.0, 0.2, 0.0};  // in L
  double yaw_rad = 0.0;               // pointing error of the beam about z ...
  double pitch_rad = 0.0;             // ... and upwards; it shines along -y
  BeamModel beam = BeamModel::kChiefRay;
  double beam_radius_m = 0.5 * units::mm;     // 1/e^2 of the irradiance, at the waist (= laser exit)
  double divergence_rad = 0.5 * units::mrad;  // 1/e^2 half angle
  std::string profile_file;                   // OpenEXR of the measured beam, for BeamModel::kProfile;
                                              // absolute once loaded
  double wavelength_per_kelvin_m = 0.0;       // against environment.reference_degC
  double pointing_yaw_per_kelvin_rad = 0.0;
  double pointing_pitch_per_kelvin_rad = 0.0;
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
};

struct AmplifierSettings {           // [amplifier]
  std::array<double, 4> offset_V{};  // one a channel
  std::array<double, 4> gain_error{};
  double noise_V = 6.0 * units::mV;  // one sample, white, standard deviation
  double hum_V = 0.0;                // amplitude of the mains hum, on all channels
  double hum_Hz = 50.0;
  double low_light_fraction = 0.02;  // below this share of the nominal power: no light
};

struct AdcSettings {  // [adc]
  /// Order in which the multiplexer takes the channels; each once. Readings and raw blocks stay in channel order.
  std::vector<std::string> scan_list = {"psd_a_x", "psd_a_y", "psd_b_x", "psd_b_y"};
  int bits = 16;
  double range_V = 10.0;       // +- range
  double rate_Hz = 250e3;      // conversions a second, all channels together
  int fifo_samples = 0;        // 0: the computer always keeps up
  double drain_rate_Hz = 1e6;  // at which it empties the FIFO
  int samples = 100;           // scans a reading
  bool every_sample = true;    // false: draw mean and deviation directly (same distribution)
};

struct TableSettings {  // [target], [reference]; [turntable], [multitooth]
  /// `harmonics = [{ component = "ez", order = 1, amplitude_arcsec = 5.0, phase_deg = 30.0 }, ...]`; amplitude_um
  /// for dx, dy, dz.
  std::vector<HarmonicSettings> harmonics;       // the reference's in its rotor frame, like every error of it
  std::string errors_file;                       // relative to the scenario's folder; the loader moves its
                                                 // content to `errors` and leaves this empty
  std::optional<TableErrors> errors;             // values per position: [target.errors] position_deg = [...], ...
  std::array<double, kComponents> random_rms{};  // [target.random] ex_arcsec ... dz_um: random smooth errors, rms
  int random_orders = 12;                        // ... orders: harmonics 1..orders, falling as 1/order
  std::array<double, kComponents> seating_sd{};  // [target.seating]: scatter of the pose at every mounting
  std::array<double, kComponents> repeatability_sd{};  // [target.repeatability]: scatter of the pose at every stop
  double half_frequency_order = 0.5;  // bearing motion once per about two turns of the unwrapped angle
  double half_frequency_tilt_rad = 0.0;
  double half_frequency_radial_m = 0.0;
  double backlash_rad = 0.0;  // full width, of the servo's encoder against the rotor
  double speed_rad_s = 30.0 * units::deg;
  double move_time_s = 0.6;  // of one step (quintic profile); longer moves keep the speed
  double settle_s = 0.4;     // in-position window after the profile
};

struct MechanicsSettings {             // [mechanics]
  std::string fidelity = "kinematic";  // kinematic | linear | bullet
  double payload_mass_kg = 0.0;        // on the reference rotor
  double payload_radius_m = 0.0;       // eccentricity ...
  double payload_azimuth_rad = 0.0;    // ... on the rotor
  double payload_height_m = 0.05;
  std::array<double, 2> axial_stiffness_N_m = {200e6, 120e6};  // target, reference
  std::array<double, 2> radial_stiffness_N_m = {100e6, 60e6};
  std::array<double, 2> tilt_stiffness_Nm_rad = {0.60e6, 0.25e6};
  double damping_ratio = 0.03;
  std::array<double, 2> servo_Hz = {30.0, 40.0};
  std::array<double, 2> friction_Nm = {0.0, 0.0};  // Coulomb level of a LuGre friction
  double step_s = 250.0 * units::us;
};

struct EnvironmentSettings {  // [environment]
  double temperature_degC = 20.0;
  double reference_degC = 20.0;  // at which wavelength and lengths are nominal
  double drift_K_h = 0.0;
  double swing_K = 0.0;  // amplitude of a periodic swing
  double swing_period_s = 1800.0;
  double random_walk_K_sqrt_h = 0.0;
  std::string temperature_file;  // time_s, temperature_degC; absolute once loaded
  double sensor_noise_K = 0.001;
};

struct AutocollimatorSettings {  // [autocollimator]
  double noise_rad = 0.02 * units::arcsec;
  double range_rad = 410.0 * units::arcsec;
  double gain_error = 0.0;
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

/// The angle device under test, of the bench encoder_comparison.
struct DeviceSettings {                   // [device]
  double noise_rad = 0.002 * units::deg;  // one reading, white, standard deviation
  bool noise_known = false;               // false: whoever evaluates readings estimates it from them
  double resolution_rad = 0.0;            // least step of the reading; 0: none
  int lines = 0;                          // [device] lines_per_turn; 0: not known
  int teeth = 0;                          // of a gear between reference and device; 0: none known
  int signal_periods = 1;                 // of its sine and cosine signals a turn
  double signal_zero_rad = 0.0;           // angle of the device at which the sine signal rises through zero
  bool signal_zero_known = false;         // false: the evaluation leaves the phase of signal faults free
};

struct EncoderProcedureSettings {            // [encoder_procedure]
  std::string kind = "stops";                // stops | sweep
  double turns = 2.0;                        // of a pass
  double start_rad = 0.0;                    // where the first pass begins
  std::vector<int> passes = {1, -1, -1, 1};  // directions; a sweep does them at each speed
  std::vector<double> mounting_rad = {0.0};  // device angle where the reference shows 0, one a set-up
  double remount_s = 600.0;                  // time a set-up takes
  int stops = 72;                            // stops: [encoder_procedure] stops_per_turn
  double stop_interval_s = 4.0;
  std::vector<double> speeds_rad_s = {36.0 * units::deg, 12.0 * units::deg};  // sweep
  double ramp_s = 0.6;       // at constant acceleration, up and down
  double rest_s = 2.0;       // behind every pass
  double interval_s = 0.08;  // between readings
};

/// Something opaque in the way of the light: a box, or a triangle mesh from a file. A [[fixture]] block.
struct FixtureSettings {
  std::string name;
  Vector3 box_m = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());  // edges; NaN: a mesh
  std::string mesh_file;                 // STL; absolute once loaded; empty: a box
  double mesh_unit_m = 1.0 * units::mm;  // what the number 1 in it means
  Vector3 position_m = Vector3::Zero();  // of the box's centre or the mesh's origin, in L ...
  double yaw_rad = 0.0;                  // about z
  bool rides_on_grating = false;         // ... or in G, and it moves with the grating
  std::string location;                  // "file.toml:31", for messages
};

/// What a diagnosis said about the effect that it added to a scenario. The twin does not look at it.
struct EffectFinding {
  std::map<std::string, double> u;  // SI, by parameter: `u_roll_mrad`; those that are known
  double log_evidence = std::numeric_limits<double>::quiet_NaN();
  double probability = std::numeric_limits<double>::quiet_NaN();
  std::string provenance;  // which run said so, and when
};

/// One cause that the bench has and the nominal bench has not: an [[effect]] block.
struct EffectSettings {
  std::string name;                          // of EffectCatalogue(bench)
  std::string where;                         // channel, PSD or axis; empty where the effect has only one place
  std::map<std::string, double> parameters;  // SI, by name without unit ("roll"); all that the catalogue has
  std::string location;                      // "file.toml:31", for messages
  EffectFinding finding = {};                // if a diagnosis added it
  // Of a signal (signal_effect.h), whose point is `where`:
  std::string signal = {};  // its kind
  std::string by = {};      // the angle or channel that it goes by
  std::string times = {};   // what its size follows
};

/// Structure without a name: a signal tabulated by the readings that showed it. An [[empirical]] block. It repeats
/// what one run had and predicts no other.
struct EmpiricalSettings {
  std::string signature;          // what it looks like, in words
  std::string channel;            // to which the signal is added
  std::vector<int> reading;       // running numbers, each once; elsewhere the signal is zero
  std::vector<double> value_m;    // one a reading, on a channel that reads a position ...
  std::vector<double> value_rad;  // ... or an angle; the other list is empty
  std::string provenance;
  std::string location;  // "file.toml:31", for messages
};

/// The keys of other benches keep their defaults.
struct Scenario {
  std::string bench;  // its name; there is no usual one
  std::string title;
  std::uint64_t seed = 1;
  bool noise_free = false;  // no random contribution and no quantisation
  LaserSettings laser;
  GratingSettings grating;
  PsdSettings psd_a;
  PsdSettings psd_b;
  AmplifierSettings amplifier;
  AdcSettings adc;
  TableSettings target;
  TableSettings reference;
  double reference_height_m = 0.080;                     // [reference] height_mm: its origin above the target's
  Eigen::Vector2d centring_m = Eigen::Vector2d::Zero();  // [reference] centring_um: its body on the target rotor
  Eigen::Vector2d mount_tilt_rad = Eigen::Vector2d::Zero();  // [reference] mount_tilt_arcsec: about x and y
  MechanicsSettings mechanics;
  EnvironmentSettings environment;
  AutocollimatorSettings autocollimator;
  ProcedureSettings procedure;
  DeviceSettings device;  // these two: bench encoder_comparison
  EncoderProcedureSettings encoder_procedure;
  MultitoothSettings multitooth;  // these four: bench turntable_autocollimator, whose turntable is
  MirrorSettings mirror;          // the target and whose multi-tooth table is the reference
  CollimatorSettings collimator;
  TurntableProcedureSettings turntable_procedure;
  TransmissionSettings transmission;  // these five: bench hob_transmission
  RingEncoderSettings table_encoder;
  RingEncoderSettings hob_encoder = {.lines = 9000, .radius_m = 50.0 * units::mm};
  InterferometerSettings interferometer;
  HobProcedureSettings hob_procedure;
  std::vector<FixtureSettings> fixtures;
  std::vector<EffectSettings> effects;
  std::vector<EmpiricalSettings> empiricals;
};

/// Reads a scenario of any bench there is (BenchFormats) and applies `overrides`: "procedure.positions=12", in TOML
/// syntax, where a single word needs no quotes. A later override wins. A list, or all blocks of [[fixture]],
/// [[effect]] or [[empirical]], are replaced as a whole.
///
/// @throws InputError with file:line for a syntax error, an unknown key (naming the nearest known one), a value out
///         of bounds or of the wrong type, no bench or an unknown one, a key of another bench, an effect, place or
///         parameter that is not in the bench's catalogue, a file that cannot be read. Overrides are reported as
///         "--set key=value".
Scenario LoadScenario(const std::string& path, const std::vector<std::string>& overrides = {});
Scenario ParseScenario(const std::string& text, const std::string& name, const std::string& folder,
                       const std::vector<std::string>& overrides = {});

/// The bench that a scenario file names; nothing else in it is looked at.
/// @throws InputError if it is no TOML, or names no bench or an unknown one.
std::string BenchOfScenarioFile(const std::string& path);

/// The scenario as TOML with every key of its bench written out, units in the keys; LoadScenario reads it back to
/// the same bits. It stands alone: errors of the tables are in it, and other files are named by absolute paths.
/// @throws std::logic_error if a number is not finite.
std::string WriteScenario(const Scenario& scenario);

/// Every key with unit, default, bounds and meaning, for `twinbench help scenario` and docs.
std::string DescribeScenarioKeys();

}  // namespace twinbench
