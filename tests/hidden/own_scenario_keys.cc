#include <map>

#include "tests/hidden/own_scenario.h"

namespace twinbench::hidden {
namespace {

// Values are chosen to move some reading by far more than its noise wherever the key can.
std::vector<KeyChange> Psd(const std::string& psd) {
  const std::vector<std::string> window = {psd + ".window=true"};
  return {{psd + ".distance_mm", "121.0"},
          {psd + ".roll_mrad", "12.0"},
          {psd + ".tilt_u_mrad", "60.0"},
          {psd + ".tilt_v_mrad", "60.0"},
          {psd + ".sensitivity_V_m", "1900.0"},
          {psd + ".width_mm", "8.0"},
          {psd + ".height_mm", "8.0"},
          {psd + ".cubic_per_m2", "3000.0"},
          {psd + ".stray_fraction", "0.02"},
          {psd + ".window", "true"},
          {psd + ".window_thickness_mm", "2.0", window},
          {psd + ".window_index", "1.8", window},
          {psd + ".window_gap_mm", "2.0", window},
          {psd + ".window_reflectance", "0.2", window},
          {psd + ".window_wedge_mrad", "4.0", window},  // more: a ghost without extent jumps over the edge
          {psd + ".window_coherent", "true", window},
          {psd + ".silicon_reflectance", "0.3"}};
}

std::vector<KeyChange> Table(const std::string& table) {
  std::vector<KeyChange> keys = {
      {table + ".harmonics", "[{component=\"ez\", order=1, amplitude_arcsec=40.0, phase_deg=30.0},"
                             " {component=\"dx\", order=2, amplitude_um=5.0, phase_deg=0.0}]"},
      {table + ".half_frequency_order", "0.43", {table + ".half_frequency_tilt_arcsec=2.0"}},
      {table + ".half_frequency_tilt_arcsec", "2.0"},
      {table + ".half_frequency_radial_um", "3.0"},
      {table + ".backlash_arcsec", "4.0"},
      {table + ".speed_deg_s", "15.0"},
      {table + ".move_time_s", "2.0"},
      {table + ".settle_s", "1.5"},
      {table + ".random.orders", "5"},
      {table + ".errors", "{position_deg=[0.0, 90.0, 180.0, 270.0], ez_arcsec=[0.0, 20.0, -5.0, 8.0]}"}};
  for (const char* component : {"ex_arcsec", "ey_arcsec", "ez_arcsec", "dx_um", "dy_um", "dz_um"}) {
    keys.push_back({table + ".random." + component, "6.0"});
    keys.push_back({table + ".seating." + component, "5.0"});
    keys.push_back({table + ".repeatability." + component, "1.5"});
  }
  return keys;
}

std::vector<KeyChange> RotaryChanges() {
  const std::vector<std::string> warm = {"environment.drift_K_h=0.5", "laser.pointing_yaw_per_kelvin_urad=20.0"};
  const std::vector<std::string> loaded = {"mechanics.payload_mass_kg=20.0", "mechanics.payload_radius_mm=60.0",
                                           "mechanics.fidelity=linear"};
  const std::vector<std::string> gaussian = {"laser.beam=gaussian"};
  const std::vector<std::string> hum = {"amplifier.hum_mV=20.0"};
  std::vector<KeyChange> keys = {
      {"noise_free", "true"},
      {"laser.wavelength_nm", "635.0"},
      {"laser.power_mW", "1.0"},
      {"laser.position_mm", "[0.5, 200.0, 0.3]"},
      {"laser.yaw_mrad", "0.4"},
      {"laser.pitch_mrad", "0.4"},
      {"laser.beam", "\"gaussian\""},
      {"laser.beam_radius_mm", "1.5", gaussian},
      {"laser.divergence_mrad", "3.0", gaussian},
      {"laser.wavelength_per_kelvin_nm", "0.25", {"environment.drift_K_h=0.5"}},
      {"laser.pointing_yaw_per_kelvin_urad", "20.0", {"environment.drift_K_h=0.5"}},
      {"laser.pointing_pitch_per_kelvin_urad", "20.0", {"environment.drift_K_h=0.5"}},
      {"grating.lines_per_mm", "620.0"},
      {"grating.width_mm", "12.0"},
      {"grating.height_mm", "12.0"},
      {"grating.efficiency", "[0.05, 0.3, 0.2, 0.4, 0.05]"},
      {"grating.point_mm", "[0.5, 31.0, 49.0]"},
      {"amplifier.offset_mV", "[40.0, -30.0, 20.0, 10.0]"},
      {"amplifier.gain_error", "[0.01, -0.008, 0.006, 0.0]"},
      {"amplifier.noise_mV", "20.0"},
      {"amplifier.hum_mV", "20.0"},
      {"amplifier.hum_frequency_Hz", "60.0", hum},
      {"amplifier.low_light_fraction", "0.2"},
      {"adc.scan_list", "[\"psd_b_y\", \"psd_a_x\", \"psd_b_x\", \"psd_a_y\"]", hum},
      {"adc.bits", "12"},
      {"adc.range_V", "20.0"},
      {"adc.rate_kHz", "100.0", hum},
      {"adc.samples", "40"},
      {"adc.every_sample", "true"},
      {"reference.height_mm", "90.0"},
      {"reference.centring_um", "[40.0, -25.0]"},
      {"reference.mount_tilt_arcsec", "[60.0, -45.0]"},
      {"mechanics.fidelity", "\"linear\""},
      {"mechanics.payload_mass_kg", "20.0", {"mechanics.payload_radius_mm=60.0"}},
      {"mechanics.payload_radius_mm", "60.0", {"mechanics.payload_mass_kg=20.0"}},
      {"mechanics.payload_azimuth_deg", "70.0", loaded},
      {"mechanics.payload_height_mm", "200.0", loaded},
      {"mechanics.axial_stiffness_N_um", "[50.0, 30.0]", loaded},
      {"mechanics.radial_stiffness_N_um", "[20.0, 10.0]", loaded},
      {"mechanics.tilt_stiffness_Nm_mrad", "[100.0, 50.0]", loaded},
      {"mechanics.damping_ratio", "0.2", loaded},
      {"mechanics.servo_Hz", "[15.0, 18.0]", loaded},
      {"mechanics.friction_Nm", "[0.5, 0.3]", loaded},
      {"mechanics.step_us", "500.0", loaded},
      {"environment.temperature_degC", "21.0", warm},
      {"environment.reference_degC", "19.0", warm},
      {"environment.drift_K_h", "0.8", warm},
      {"environment.swing_mK", "300.0", warm},
      {"environment.swing_period_s", "2400.0", {"environment.swing_mK=300.0", warm[1]}},
      {"environment.random_walk_K_sqrt_h", "0.3", warm},
      {"environment.sensor_noise_mK", "30.0", warm},
      {"autocollimator.noise_arcsec", "0.2"},
      {"autocollimator.range_arcsec", "350.0"},
      {"autocollimator.gain_error", "0.004"},
      {"procedure.phases", "[\"calibration\", \"stability\", \"verification\", \"full_circle\"]"},
      {"procedure.positions", "18"},
      {"procedure.shifts", "[0, 2, 7]"},
      {"procedure.passes", "[1, -1]"},
      {"procedure.clamping", "\"reclamp\""},
      {"procedure.dwell_s", "[0.5, 2.0, 6.0]"},
      {"procedure.run_up_steps", "0.2", {"target.backlash_arcsec=4.0"}},
      {"procedure.remount_s", "60.0"},
      {"procedure.sweep_arcsec", "200.0"},
      {"procedure.sweep_points", "9"},
      {"procedure.stability_s", "600.0", {"procedure.phases=[\"calibration\", \"stability\", \"full_circle\"]"}},
      {"procedure.stability_interval_s", "30.0", {"procedure.phases=[\"calibration\", \"stability\", \"full_circle\"]"}},
      {"procedure.verification_points", "5", {"procedure.phases=[\"calibration\", \"verification\", \"full_circle\"]"}},
      {"procedure.keep_raw", "true", {"adc.every_sample=true"}}};
  for (const auto& part : {Psd("psd_a"), Psd("psd_b"), Table("target"), Table("reference")})
    keys.insert(keys.end(), part.begin(), part.end());
  return keys;
}

std::vector<KeyChange> EncoderChanges() {
  const std::vector<std::string> sweep = {"encoder_procedure.kind=sweep"};
  return {{"noise_free", "true"},
          {"device.noise_deg", "0.005"},
          {"device.noise_known", "true"},
          {"device.resolution_deg", "0.005"},
          {"device.lines_per_turn", "30"},
          {"device.teeth", "22"},
          {"device.signal_periods", "3"},
          {"device.signal_zero_deg", "40.0"},
          {"device.signal_zero_known", "true"},
          {"encoder_procedure.kind", "\"sweep\""},
          {"encoder_procedure.turns", "1.0"},
          {"encoder_procedure.start_deg", "77.0"},
          {"encoder_procedure.passes", "[1, -1]"},
          {"encoder_procedure.mounting_deg", "[0.0, 120.0]"},
          {"encoder_procedure.remount_s", "60.0", {"encoder_procedure.mounting_deg=[0.0, 120.0]"}},
          {"encoder_procedure.stops_per_turn", "48"},
          {"encoder_procedure.stop_interval_s", "9.0"},
          {"encoder_procedure.speeds_deg_s", "[20.0]", sweep},
          {"encoder_procedure.ramp_s", "1.5", sweep},
          {"encoder_procedure.rest_s", "5.0", sweep},
          {"encoder_procedure.interval_s", "0.15", sweep}};
}

const std::vector<KeyLeftOut> kOfEveryBench = {{"bench", "says which bench this is"},
                                               {"title", "is for people"},
                                               {"seed", "every case has its own"}};

std::vector<KeyLeftOut> Beside(std::vector<KeyLeftOut> further) {
  further.insert(further.begin(), kOfEveryBench.begin(), kOfEveryBench.end());
  return further;
}

}  // namespace

const std::vector<KeyChange>& KeyChanges(const std::string& bench) {
  static const std::map<std::string, std::vector<KeyChange>> changes = {{"rotary_4dof", RotaryChanges()},
                                                                        {"encoder_comparison", EncoderChanges()}};
  return changes.at(bench);
}

const std::vector<KeyLeftOut>& KeysLeftOut(const std::string& bench) {
  static const std::map<std::string, std::vector<KeyLeftOut>> left_out = {
      {"rotary_4dof",
       Beside({{"laser.profile_file", "needs an OpenEXR file"},
               {"grating.efficiency_file", "needs a file"},
               {"environment.temperature_file", "needs a file"},
               {"target.errors_file", "its content is in target.errors"},
               {"reference.errors_file", "its content is in reference.errors"},
               {"adc.fifo_samples", "a FIFO that runs full ends the run"},
               {"adc.drain_rate_kHz", "matters only to a FIFO that runs full"}})},
      {"encoder_comparison", Beside({})}};
  return left_out.at(bench);
}

}  // namespace twinbench::hidden
