#include "tests/own_scenario/own_scenario.h"
#include "twin/benches/names.h"

namespace twinbench::own_rotary {
namespace {

using test::Change, test::OwnKey;

// Values are chosen to move some reading by far more than its noise wherever the key can.
std::vector<OwnKey> Psd(const std::string& psd) {
  const std::vector<std::string> window = {psd + ".window=true"};
  return {Change(psd + ".distance_mm", "121.0"),
          Change(psd + ".roll_mrad", "12.0"),
          Change(psd + ".tilt_u_mrad", "60.0"),
          Change(psd + ".tilt_v_mrad", "60.0"),
          Change(psd + ".sensitivity_V_m", "1900.0"),
          Change(psd + ".width_mm", "8.0"),
          Change(psd + ".height_mm", "8.0"),
          Change(psd + ".cubic_per_m2", "3000.0"),
          Change(psd + ".stray_fraction", "0.02"),
          Change(psd + ".window", "true"),
          Change(psd + ".window_thickness_mm", "2.0", window),
          Change(psd + ".window_index", "1.8", window),
          Change(psd + ".window_gap_mm", "2.0", window),
          Change(psd + ".window_reflectance", "0.2", window),
          Change(psd + ".window_wedge_mrad", "4.0", window),  // more: a ghost without extent jumps over the edge
          Change(psd + ".window_coherent", "true", window),
          Change(psd + ".silicon_reflectance", "0.3"),
          Change(psd + ".distance_expansion_ppm_K", "200.0", {"environment.drift_K_h=0.5"}),
          Change(psd + ".post_growth_um_K", "5.0", {"environment.drift_K_h=0.5"}),
          Change(psd + ".responsivity_A_W", "0.001"),
          Change(psd + ".dark_current_nA", "1e5"),
          Change(psd + ".background_nA", "5e4", {"laser.pitch_mrad=5.0"}),
          Change(psd + ".electrode_resistance_kohm", "0.01"),
          Change(psd + ".bandwidth_kHz", "1e5")};
}

std::vector<OwnKey> Table(const std::string& table) {
  std::vector<OwnKey> keys = {
      Change(table + ".harmonics",
             "[{component=\"ez\", order=1, amplitude_arcsec=40.0, phase_deg=30.0},"
             " {component=\"dx\", order=2, amplitude_um=5.0, phase_deg=0.0}]"),
      Change(table + ".half_frequency_order", "0.43", {table + ".half_frequency_tilt_arcsec=2.0"}),
      Change(table + ".half_frequency_tilt_arcsec", "2.0"),
      Change(table + ".half_frequency_radial_um", "3.0"),
      Change(table + ".backlash_arcsec", "4.0"),
      Change(table + ".speed_deg_s", "5.0"),
      Change(table + ".move_time_s", "2.0"),
      Change(table + ".settle_s", "1.5"),
      Change(table + ".random.orders", "5"),
      Change(table + ".errors", "{position_deg=[0.0, 90.0, 180.0, 270.0], ez_arcsec=[0.0, 20.0, -5.0, 8.0]}"),
      Change(table + ".compensation",
             "{position_deg=[0.0, 90.0, 180.0, 270.0], correction_arcsec=[0.0, 20.0, -5.0, 8.0]}")};
  for (const char* component : {"ex_arcsec", "ey_arcsec", "ez_arcsec", "dx_um", "dy_um", "dz_um"}) {
    keys.push_back(Change(table + ".random." + component, "6.0"));
    keys.push_back(Change(table + ".seating." + component, "5.0"));
    keys.push_back(Change(table + ".repeatability." + component, "1.5"));
  }
  return keys;
}

std::vector<OwnKey> RotaryChanges() {
  const std::vector<std::string> warm = {"environment.drift_K_h=0.5", "laser.pointing_yaw_per_kelvin_urad=20.0"};
  const std::vector<std::string> loaded = {"mechanics.payload_mass_kg=20.0", "mechanics.payload_radius_mm=60.0",
                                           "mechanics.fidelity=linear"};
  const std::vector<std::string> rubbing = {"mechanics.friction_Nm=[0.5, 0.3]", "mechanics.fidelity=linear"};
  const std::vector<std::string> gaussian = {"laser.beam=gaussian"};
  const std::vector<std::string> lit = {"laser.pitch_mrad=5.0", "psd_a.background_nA=1e5"};
  const std::vector<std::string> eccentric = {"reference.centring_um=[1000.0, 500.0]"};
  const std::vector<std::string> rough = {"grating.speckle_um=2.0"};
  const std::vector<std::string> windy = {"optics.wander_urad=1.0"};
  const std::vector<std::string> hum = {"amplifier.hum_mV=20.0"};
  std::vector<OwnKey> keys = {
      Change("noise_free", "true"),
      Change("laser.wavelength_nm", "635.0"),
      Change("laser.power_mW", "1.0"),
      Change("laser.position_mm", "[0.5, 200.0, 0.3]"),
      Change("laser.yaw_mrad", "0.4"),
      Change("laser.pitch_mrad", "0.4"),
      Change("laser.beam", "\"gaussian\""),
      Change("laser.beam_radius_mm", "1.5", gaussian),
      Change("laser.divergence_mrad", "3.0", gaussian),
      Change("laser.wavelength_per_kelvin_nm", "0.25", {"environment.drift_K_h=0.5"}),
      {"laser.mode_hop_K", {}, "a noisy thermometer does not tell which reading was the first behind a hop"},
      {"laser.mode_spacing_nm", {}, "of those hops"},
      Change("laser.post_growth_um_K", "5.0", {"environment.drift_K_h=0.5"}),
      Change("grating.expansion_ppm_K", "20.0", {"environment.drift_K_h=0.5"}),
      Change("laser.pointing_yaw_per_kelvin_urad", "20.0", {"environment.drift_K_h=0.5"}),
      Change("laser.pointing_pitch_per_kelvin_urad", "20.0", {"environment.drift_K_h=0.5"}),
      Change("laser.rin_dB_Hz", "-80.0", lit),
      Change("laser.power_drift_percent_h", "-30.0", lit),
      Change("grating.speckle_um", "2.0"),
      Change("grating.speckle_correlation_arcsec", "60.0", rough),
      Change("grating.sphere_nm", "500.0", eccentric),
      Change("grating.astigmatism_nm", "500.0", eccentric),
      Change("grating.ruling_chirp_ppm_mm", "50.0", eccentric),
      Change("grating.ruling_fan_urad_mm", "50.0", eccentric),
      {"grating.flatness_file", {}, "a file; optics.*FormedGrating*"},
      {"grating.ruling_file", {}, "a file; optics.*FormedGrating*"},
      Change("optics.wander_urad", "1.0"),
      Change("optics.wander_corner_Hz", "20.0", windy),
      Change("amplifier.low_pass_kHz", "0.5", hum),
      Change("adc.dnl_lsb", "0.4", {"amplifier.noise_mV=0.2"}),
      Change("grating.lines_per_mm", "620.0"),
      Change("grating.width_mm", "12.0"),
      Change("grating.height_mm", "12.0"),
      Change("grating.efficiency", "[0.05, 0.3, 0.2, 0.4, 0.05]"),
      Change("grating.point_mm", "[0.5, 31.0, 49.0]"),
      Change("optics.fidelity", "\"closed\""),
      Change("amplifier.offset_mV", "[40.0, -30.0, 20.0, 10.0]"),
      Change("amplifier.gain_error", "[0.01, -0.008, 0.006, 0.0]"),
      Change("amplifier.noise_mV", "20.0"),
      Change("amplifier.flicker_mV", "0.05"),
      Change("amplifier.hum_mV", "20.0"),
      Change("amplifier.hum_frequency_Hz", "60.0", hum),
      Change("amplifier.low_light_fraction", "0.2"),
      Change("adc.scan_list", "[\"psd_b_y\", \"psd_a_x\", \"psd_b_x\", \"psd_a_y\"]", hum),
      Change("adc.jitter_us", "2.0", hum),
      Change("adc.lost_fraction", "0.2"),
      {"adc.inl_file", {}, "a file; sim.Electronics*"},
      {"adc.dnl_file", {}, "a file; sim.CodeWidths*"},
      Change("adc.bits", "12"),
      Change("adc.range_V", "20.0"),
      Change("adc.rate_kHz", "100.0", hum),
      Change("adc.samples", "40"),
      Change("adc.every_sample", "true"),
      Change("reference.height_mm", "90.0"),
      Change("reference.centring_um", "[40.0, -25.0]"),
      Change("reference.mount_tilt_arcsec", "[60.0, -45.0]"),
      Change("mechanics.fidelity", "\"linear\""),
      Change("mechanics.payload_mass_kg", "20.0", {"mechanics.payload_radius_mm=60.0"}),
      Change("mechanics.payload_radius_mm", "60.0", {"mechanics.payload_mass_kg=20.0"}),
      Change("mechanics.payload_azimuth_deg", "70.0", loaded),
      Change("mechanics.payload_height_mm", "200.0", loaded),
      Change("mechanics.axial_stiffness_N_um", "[50.0, 30.0]", loaded),
      Change("mechanics.radial_stiffness_N_um", "[20.0, 10.0]", loaded),
      Change("mechanics.tilt_stiffness_Nm_mrad", "[100.0, 50.0]", loaded),
      Change("mechanics.damping_ratio", "0.2", loaded),
      Change("mechanics.servo_Hz", "[15.0, 18.0]", loaded),
      Change("mechanics.friction_Nm", "[0.5, 0.3]", loaded),
      Change("mechanics.step_us", "500.0", loaded),
      Change("mechanics.friction_static_ratio", "[1.5, 1.5]", rubbing),
      Change("mechanics.friction_stribeck_arcsec_s", "[50.0, 50.0]", rubbing),
      Change("mechanics.friction_presliding_arcsec", "[30.0, 30.0]", rubbing),
      Change("mechanics.friction_viscous_Nm_s_rad", "[0.5, 0.5]", {"mechanics.fidelity=linear"}),
      Change("mechanics.cable_stiffness_Nm_rad", "[0.5, 0.5]", {"mechanics.fidelity=linear"}),
      Change("mechanics.cable_torque_Nm", "[0.3, 0.3]", {"mechanics.fidelity=linear"}),
      Change("mechanics.cable_azimuth_deg", "[40.0, 70.0]",
             {"mechanics.fidelity=linear", "mechanics.cable_torque_Nm=[0.3, 0.3]"}),
      Change("mechanics.unbalance_g_mm", "[60000.0, 30000.0]"),
      Change("mechanics.unbalance_azimuth_deg", "[30.0, 90.0]", {"mechanics.unbalance_g_mm=[60000.0, 30000.0]"}),
      Change("mechanics.encoder_resolution_arcsec", "[0.02, 0.02]", {"mechanics.fidelity=linear"}),
      Change("mechanics.encoder_subdivision_arcsec", "[0.5, 0.3]"),
      Change("mechanics.encoder_periods", "9001", {"mechanics.encoder_subdivision_arcsec=[0.5, 0.3]"}),
      Change("mechanics.asynchronous_radial_um", "[0.02, 0.02]"),
      Change("mechanics.asynchronous_axial_um", "[0.02, 0.02]"),
      Change("mechanics.asynchronous_tilt_arcsec", "[0.01, 0.01]"),
      Change("mechanics.vibration", "\"VC-C\""),
      Change("mechanics.vibration_frequency_Hz", "[10.0, 40.0]",
             {"mechanics.vibration_velocity_um_s=[5.0, 5.0]", "mechanics.vibration=listed"}),
      Change("mechanics.vibration_velocity_um_s", "[5.0, 5.0]",
             {"mechanics.vibration_frequency_Hz=[10.0, 40.0]", "mechanics.vibration=listed"}),
      Change("environment.temperature_degC", "21.0", warm),
      Change("environment.reference_degC", "19.0", warm),
      Change("environment.drift_K_h", "0.8", warm),
      Change("environment.swing_mK", "300.0", warm),
      Change("environment.swing_period_s", "2400.0", {"environment.swing_mK=300.0", warm[1]}),
      Change("environment.random_walk_K_sqrt_h", "0.3", warm),
      Change("environment.sensor_noise_mK", "30.0", warm),
      Change("autocollimator.noise_arcsec", "0.2"),
      Change("autocollimator.range_arcsec", "350.0"),
      Change("autocollimator.gain_error", "0.004"),
      Change("procedure.phases", "[\"calibration\", \"stability\", \"verification\", \"full_circle\"]"),
      Change("procedure.positions", "18"),
      Change("procedure.shifts", "[0, 2, 7]"),
      Change("procedure.passes", "[1, -1]"),
      Change("procedure.clamping", "\"reclamp\""),
      Change("procedure.dwell_s", "[0.5, 2.0, 6.0]"),
      Change("procedure.run_up_steps", "0.2", {"target.backlash_arcsec=4.0"}),
      Change("procedure.remount_s", "60.0"),
      Change("procedure.sweep_arcsec", "200.0"),
      Change("procedure.sweep_points", "9"),
      Change("procedure.stability_s", "600.0",
             {"procedure.phases=[\"calibration\", \"stability\", \"full_circle\"]"}),
      Change("procedure.stability_interval_s", "30.0",
             {"procedure.phases=[\"calibration\", \"stability\", \"full_circle\"]"}),
      Change("procedure.verification_points", "5",
             {"procedure.phases=[\"calibration\", \"verification\", \"full_circle\"]"}),
      Change("procedure.keep_raw", "true", {"adc.every_sample=true"})};
  for (const auto& part : {Psd("psd_a"), Psd("psd_b"), Table("target"), Table("reference")})
    keys.insert(keys.end(), part.begin(), part.end());
  return keys;
}

std::vector<OwnKey> Keys() {
  std::vector<OwnKey> keys = RotaryChanges();
  const std::vector<OwnKey> left_out = {{"bench", {}, "another bench"},
                                        {"title", {}, "words"},
                                        {"seed", {}, "every run has its own"},
                                        {"repeat", {"repeat=3"}},
                                        {"laser.profile_file", {}, "needs an OpenEXR file"},
                                        {"optics.profile_rays", {}, "of a profile"},
                                        {"grating.efficiency_file", {}, "needs a file"},
                                        {"environment.temperature_file", {}, "needs a file"},
                                        {"target.errors_file", {}, "its content is in target.errors"},
                                        {"reference.errors_file", {}, "its content is in reference.errors"},
                                        {"target.compensation_file", {}, "its content is in target.compensation"},
                                        {"reference.compensation_file", {}, "likewise"},
                                        {"adc.fifo_samples", {}, "a FIFO that runs full ends the run"},
                                        {"adc.drain_rate_kHz", {}, "matters only to a FIFO that runs full"}};
  keys.insert(keys.end(), left_out.begin(), left_out.end());
  return keys;
}

// Two thirds of the scenario's stops tell everything apart and take less time.
const std::vector<std::string> kBase = {"procedure.positions=24", "procedure.shifts=[0, 1, 5, 8]",
                                        "adc.every_sample=false", "mechanics.fidelity=kinematic"};

}  // namespace

test::OwnBench Bench() {
  return {kRotaryBench, "rotary_4dof.toml", kBase, Keys(), kBase, 20};
}

}  // namespace twinbench::own_rotary
