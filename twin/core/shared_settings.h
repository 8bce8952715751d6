#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "twin/core/compensation_table.h"
#include "twin/core/harmonic_settings.h"
#include "twin/core/table_errors.h"
#include "twin/core/units.h"

/// What scenarios of several benches say. A key is a field's name with the unit of the file: noise_V is `noise_mV`.
namespace twinbench {

struct AmplifierSettings {           // [amplifier]
  std::array<double, 4> offset_V{};  // one a channel
  std::array<double, 4> gain_error{};
  double noise_V = 6.0 * units::mV;  // one sample, white, standard deviation
  double flicker_V = 0.0;            // 1 / f noise of every channel: standard deviation of one decade
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
  std::string inl_file;        // integral non-linearity: CSV of voltage_V, error_mV; absolute once loaded
  double jitter_s = 0.0;       // of the instants of conversion, standard deviation
  double lost_fraction = 0.0;  // of scans that do not arrive
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
  double move_time_s = 0.6;                       // of one step (quintic profile); longer moves keep the speed
  double settle_s = 0.4;                          // in-position window after the profile
  std::string compensation_file;                  // as errors_file, moved to `compensation`
  std::optional<CompensationTable> compensation;  // added to the angles that the table is commanded to
};

struct MechanicsSettings {             // [mechanics]; lists: target, reference
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
  std::array<double, 2> friction_Nm = {0.0, 0.0};  // Coulomb level of a LuGre friction, and what belongs to it
  std::array<double, 2> friction_static_ratio = {1.2, 1.2};
  std::array<double, 2> friction_stribeck_rad_s = {1e-3, 1e-3};
  std::array<double, 2> friction_presliding_rad = {50e-6, 50e-6};
  std::array<double, 2> friction_viscous_Nm_s{};
  std::array<double, 2> cable_stiffness_Nm_rad{};
  std::array<double, 2> cable_torque_Nm{};  // amplitude, once a turn
  std::array<double, 2> cable_azimuth_rad{};
  std::array<double, 2> unbalance_kg_m{};
  std::array<double, 2> unbalance_azimuth_rad{};
  std::array<double, 2> encoder_resolution_rad{};
  std::array<double, 2> encoder_subdivision_rad{};
  int encoder_periods = 36000;                    // of both graduations, a turn
  std::array<double, 2> asynchronous_radial_m{};  // root mean squares
  std::array<double, 2> asynchronous_axial_m{};
  std::array<double, 2> asynchronous_tilt_rad{};
  double step_s = 250.0 * units::us;
  std::string vibration = "none";                       // auto | none | VC-A ... VC-G | listed, which is
  std::vector<double> vibration_frequency_Hz = {10.0};  // centres of third-octave bands ...
  std::vector<double> vibration_velocity_m_s = {0.0};   // ... and their root mean square velocities
  bool operator==(const MechanicsSettings&) const = default;
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

}  // namespace twinbench
