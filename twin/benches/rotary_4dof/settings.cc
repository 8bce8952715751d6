#include "twin/benches/rotary_4dof/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "twin/benches/rotary_4dof/format.h"
#include "twin/core/errors.h"
#include "twin/core/scenario_together.h"
#include "twin/core/schema_table.h"

namespace twinbench::benches::rotary {
namespace {

using namespace schema;

void AddLaser(Keys& keys, LaserSettings& s) {
  Table t(keys, "laser");
  t.Add("wavelength", kNm, {200, 2000}, &s.wavelength_m, "in air");
  t.Add("power", kMw, Positive(10000), &s.power_W, "of the beam");
  t.Add("position", kMm, Within(5000), List(s.position_m), "of the laser's exit in L: x, y, z");
  t.Add("yaw", kMrad, Within(500), &s.yaw_rad, "pointing error of the beam about z");
  t.Add("pitch", kMrad, Within(500), &s.pitch_rad, "pointing error of the beam, upwards");
  t.Text("beam", &s.beam, {"chief_ray", "gaussian", "profile"}, "how the beam is carried to the PSDs");
  t.Add("beam_radius", kMm, Positive(50), &s.beam_radius_m, "1/e^2 of the irradiance, at the waist");
  t.Add("divergence", kMrad, UpTo(100), &s.divergence_rad, "1/e^2 half angle");
  t.File("profile_file", s.profile_file, "OpenEXR of the measured beam, for beam = \"profile\"");
  t.Add("wavelength_per_kelvin", kNm, Within(10), &s.wavelength_per_kelvin_m, "against environment.reference_degC");
  t.Add("mode_hop", {"K"}, UpTo(1000), &s.mode_hop_K,
        "warming after which the diode hops to its next mode; 0: never");
  t.Add("mode_spacing", kNm, Within(10), &s.mode_spacing_m, "of neighbouring modes");
  t.Add("post_growth", {"um_K", units::um}, Within(1000), &s.post_growth_m_K,
        "of its height, against environment.reference_degC");
  t.Add("pointing_yaw_per_kelvin", kUrad, Within(10000), &s.pointing_yaw_per_kelvin_rad, "likewise");
  t.Add("pointing_pitch_per_kelvin", kUrad, Within(10000), &s.pointing_pitch_per_kelvin_rad, "likewise");
  t.Add("rin", {"dB_Hz"}, {-250, 0}, &s.rin_dB_Hz, "relative intensity noise, white; 0: none");
  t.Add("power_drift", {"percent_h", 0.01 / units::hour}, Within(100), &s.power_drift_per_s, "of its power");
}

void AddRuling(Table& t, GratingSettings& s) {
  constexpr double kMostSag_nm = 1e4;  // thirty fringes: a bent plate, no grating
  t.Add("sphere", kNm, Within(kMostSag_nm), &s.sphere_m, "its front at half its width above its middle");
  t.Add("astigmatism", kNm, Within(kMostSag_nm), &s.astigmatism_m, "the same along x, as much lower along z");
  t.Add("ruling_chirp", {"ppm_mm", 1e-6 / units::mm}, Within(100), &s.ruling_chirp_per_m,
        "growth of the grooves' distance");
  t.Add("ruling_fan", {"urad_mm", units::urad / units::mm}, Within(100), &s.ruling_fan_rad_m,
        "turn of the grooves along x");
  t.File("flatness_file", s.flatness_file, "OpenEXR of the front's height [um]");
  t.File("ruling_file", s.ruling_file, "OpenEXR of how far the grooves lie towards +x [um]");
}

void AddGrating(Keys& keys, GratingSettings& s) {
  Table t(keys, "grating");
  t.Add("lines", {"per_mm", 1e3}, Positive(10000), &s.lines_per_m, "grooves a length");
  t.Add("width", kMm, Positive(1000), &s.width_m, "across the grooves");
  t.Add("height", kMm, Positive(1000), &s.height_m, "along the grooves");
  t.Add("efficiency", kPure, UpTo(1), List(s.efficiency), "power share of the orders -2, -1, 0, 1, 2");
  t.File("efficiency_file", s.efficiency_file,
         "instead, by incidence: CSV of sin_incidence, m-2, m-1, m0, m+1, m+2");
  t.Add("expansion", {"ppm_K", 1e-6}, Within(1000), &s.expansion_per_K, "of the distance of its grooves");
  t.Add("speckle", kUm, UpTo(1000), &s.speckle_m, "by which speckle moves a spot along each axis, rms");
  t.Add("speckle_correlation", kArcsec, Positive(36000), &s.speckle_correlation_rad,
        "turn of the grating after which 1/e of it is the same");
  AddRuling(t, s);
  t.Add("point", kMm, Within(300), List(s.point_m), "the spot, from the reference table's origin: x, y, z");
}

void AddOptics(Keys& keys, LightSettings& s) {
  Table t(keys, "optics");
  t.Text("fidelity", &s.fidelity, {"traced", "closed"},
         "how the laser's light is found: by Embree, or by a formula");
  t.Add("profile_rays", kPure, {1, 1e7}, &s.profile_rays,
        "traced: places of a measured beam resolved; its pixels are gathered to so many at most");
  t.Add("wander", kUrad, UpTo(10000), &s.wander_rad, "of light on a metre of moving air, rms");
  t.Add("wander_corner", kHz, Positive(1000), &s.wander_corner_Hz, "wind over the beam's diameter");
}

void AddPsd(Keys& keys, const std::string& table, PsdSettings& s) {
  Table t(keys, table);
  t.Add("distance", kMm, Positive(10000), &s.distance_m, "from the spot on the grating to the centre");
  t.Add("roll", kMrad, Within(3200), &s.roll_rad, "about the nominal order, right-handed towards the light");
  t.Add("tilt_u", kMrad, Within(1000), &s.tilt_u_rad, "about its u axis");
  t.Add("tilt_v", kMrad, Within(1000), &s.tilt_v_rad, "about its v axis");
  t.Add("sensitivity", {"V_m"}, Positive(1e6), &s.sensitivity_V_m, "of the output to the spot's place [V/m]");
  t.Add("width", kMm, Positive(100), &s.width_m, "of the active area, along u");
  t.Add("height", kMm, Positive(100), &s.height_m, "of the active area, along v");
  t.Add("cubic", {"per_m2"}, Within(1e7), &s.cubic_per_m2, "non-linearity: u -> u (1 + cubic r^2)");
  t.Add("stray_fraction", kPure, UpTo(0.9), &s.stray_fraction, "uniform stray light / signal");
  t.Flag("window", s.window, "a window in front of the silicon");
  t.Add("window_thickness", kMm, Positive(20), &s.window_thickness_m, "of the glass");
  t.Add("window_index", kPure, {1, 4}, &s.window_index, "refractive index of the glass");
  t.Add("window_gap", kMm, Positive(50), &s.window_gap_m, "from the window's back to the silicon");
  t.Add("window_reflectance", kPure, UpTo(0.99), &s.window_reflectance, "of one surface");
  t.Add("window_wedge", kMrad, Within(99), &s.window_wedge_rad, "between the faces");
  t.Flag("window_coherent", s.window_coherent, "interference between the window's faces");
  t.Add("silicon_reflectance", kPure, UpTo(0.5), &s.silicon_reflectance, "above 0: ghosts by way of the grating");
  t.Add("distance_expansion", {"ppm_K", 1e-6}, Within(1000), &s.distance_expansion_per_K,
        "of what holds it at its distance");
  t.Add("post_growth", {"um_K", units::um}, Within(1000), &s.post_growth_m_K,
        "of its height, against environment.reference_degC");
  t.Add("responsivity", {"A_W"}, Positive(2), &s.responsivity_A_W, "photocurrent over light [A/W]");
  t.Add("dark_current", {"nA", 1e-9}, UpTo(1e6), &s.dark_current_A, "of the detector");
  t.Add("background", {"nA", 1e-9}, UpTo(1e5), &s.background_A, "that counts as signal: ambient light");
  t.Add("electrode_resistance", {"kohm", 1e3}, Positive(1e6), &s.electrode_resistance_ohm,
        "between the electrodes of an axis");
  t.Add("bandwidth", kKilohertz, Positive(1e6), &s.bandwidth_Hz, "of the read-out, for the light's own noise");
}

void AddAmplifier(Keys& keys, AmplifierSettings& s, ChainSettings& chain) {
  Table t(keys, "amplifier");
  t.Add("offset", kMillivolt, Within(20000), List(s.offset_V), "psd_a_x, psd_a_y, psd_b_x, psd_b_y");
  t.Add("gain_error", kPure, Within(0.9), List(s.gain_error), "of the same channels");
  t.Add("noise", kMillivolt, UpTo(10000), &s.noise_V, "of one sample, white, standard deviation");
  t.Add("flicker", kMillivolt, UpTo(10000), &s.flicker_V, "1/f noise, standard deviation of one decade");
  t.Add("hum", kMillivolt, UpTo(10000), &s.hum_V, "amplitude of the mains hum, on all channels");
  t.Add("hum_frequency", kHz, Positive(1e6), &s.hum_Hz, "of the hum");
  t.Add("low_pass", kKilohertz, UpTo(1e6), &chain.low_pass_Hz, "of one pole before the converter; 0: none");
  t.Add("low_light_fraction", kPure, UpTo(1), &s.low_light_fraction, "of the nominal power; below: no light");
}

void AddAdc(Keys& keys, AdcSettings& s, ChainSettings& chain) {
  Table t(keys, "adc");
  t.Text("scan_list", &s.scan_list, {kChannelNames.begin(), kChannelNames.end()}, "order of conversion, each once");
  t.Add("bits", kPure, {4, 16}, &s.bits, "of one conversion");
  t.Add("range", kVolt, Positive(1000), &s.range_V, "± this voltage");
  t.Add("rate", kKilohertz, Between(1e-3, 1e6), &s.rate_Hz, "conversions, all channels together");
  t.Add("fifo_samples", kPure, UpTo(kHuge), &s.fifo_samples, "0: the computer always keeps up");
  t.Add("drain_rate", kKilohertz, Positive(1e6), &s.drain_rate_Hz, "at which the computer empties the FIFO");
  t.Add("samples", kPure, {1, 1e7}, &s.samples, "scans a reading");
  t.Flag("every_sample", s.every_sample, "false: draw mean and deviation of a block at once");
  t.File("inl_file", s.inl_file, "integral non-linearity: CSV of voltage_V, error_mV");
  t.Add("dnl", {"lsb"}, UpTo(0.4), &chain.dnl_lsb, "differential non-linearity, rms");
  t.File("dnl_file", chain.dnl_file, "instead, as measured: CSV of code and width (in LSB), or code and dnl_lsb");
  t.Add("jitter", kMicrosecond, UpTo(1e6), &s.jitter_s, "of the instants of conversion, standard deviation");
  t.Add("lost_fraction", kPure, UpTo(0.9), &s.lost_fraction, "of scans that do not arrive");
}

void AddReferenceMounting(Keys& keys, Scenario& s) {
  Table t(keys, "reference");
  t.Add("height", kMm, Within(5000), &RotaryOf(s).reference_height_m, "of its origin above the target's");
  t.Add("centring", kUm, Within(50000), List(RotaryOf(s).centring_m), "of its body on the target rotor: x, y");
  t.Add("mount_tilt", kArcsec, Within(36000), List(RotaryOf(s).mount_tilt_rad),
        "of its body on the target rotor: about x, y");
}

void AddMechanics(Keys& keys, MechanicsSettings& s) {
  Table t(keys, "mechanics");
  t.Text("fidelity", &s.fidelity, {"kinematic", "linear", "bullet"}, "how the bodies move");
  t.Add("payload_mass", {"kg"}, UpTo(10000), &s.payload_mass_kg, "on the reference rotor");
  t.Add("payload_radius", kMm, UpTo(10000), &s.payload_radius_m, "eccentricity of its centre of mass");
  t.Add("payload_azimuth", kDeg, Within(360), &s.payload_azimuth_rad, "of it on the rotor");
  t.Add("payload_height", kMm, Within(10000), &s.payload_height_m, "of its centre of mass");
  t.Add("axial_stiffness", {"N_um", 1e6}, Positive(1e6), List(s.axial_stiffness_N_m), "target, reference");
  t.Add("radial_stiffness", {"N_um", 1e6}, Positive(1e6), List(s.radial_stiffness_N_m), "target, reference");
  t.Add("tilt_stiffness", {"Nm_mrad", 1e3}, Positive(1e9), List(s.tilt_stiffness_Nm_rad), "target, reference");
  t.Add("damping_ratio", kPure, UpTo(2), &s.damping_ratio, "of the bearings");
  t.Add("servo", kHz, Positive(10000), List(s.servo_Hz), "bandwidth: target, reference");
  t.Add("step", kMicrosecond, Between(0.1, 100000), &s.step_s, "longest, of friction within a servo period");
}

/// What acts on the drives; each key has an entry for the target and one for the reference.
void AddDrives(Keys& keys, MechanicsSettings& s) {
  Table t(keys, "mechanics");
  t.Add("friction", {"Nm"}, UpTo(10000), List(s.friction_Nm), "Coulomb level of LuGre bristles: target, reference");
  t.Add("friction_static_ratio", kPure, {1.0, 10.0}, List(s.friction_static_ratio),
        "of breakaway to Coulomb torque");
  t.Add("friction_stribeck", {"arcsec_s", units::arcsec}, Positive(3.6e6), List(s.friction_stribeck_rad_s),
        "speed over which breakaway falls to Coulomb torque");
  t.Add("friction_presliding", kArcsec, Positive(3600), List(s.friction_presliding_rad),
        "by which bristles bend before they slip");
  t.Add("friction_viscous", {"Nm_s_rad"}, UpTo(10000), List(s.friction_viscous_Nm_s), "torque by speed");
  t.Add("cable_stiffness", {"Nm_rad"}, UpTo(10000), List(s.cable_stiffness_Nm_rad), "of cables that wind up");
  t.Add("cable_torque", {"Nm"}, UpTo(10000), List(s.cable_torque_Nm), "of bent cables, amplitude once per turn");
  t.Add("cable_azimuth", kDeg, Within(360), List(s.cable_azimuth_rad), "of the rotor where the latter holds it");
  t.Add("unbalance", {"g_mm", 1e-6}, UpTo(1e9), List(s.unbalance_kg_m), "of the rotors; its weight is a payload's");
  t.Add("unbalance_azimuth", kDeg, Within(360), List(s.unbalance_azimuth_rad), "on the rotors");
  t.Add("encoder_resolution", kArcsec, UpTo(3600), List(s.encoder_resolution_rad),
        "of the servos' encoders; 0: none");
  t.Add("encoder_subdivision", kArcsec, Within(3.0), List(s.encoder_subdivision_rad),
        "error within a period of their graduation, amplitude");
  t.Add("encoder_periods", kPure, {1, 1e6}, &s.encoder_periods, "of the graduation, per turn");
}

void AddRestlessness(Keys& keys, MechanicsSettings& s) {
  Table t(keys, "mechanics");
  t.Add("asynchronous_radial", kUm, UpTo(1000), List(s.asynchronous_radial_m),
        "rms of what does not repeat from turn to turn, along x and y: target, reference");
  t.Add("asynchronous_axial", kUm, UpTo(1000), List(s.asynchronous_axial_m), "the same along z");
  t.Add("asynchronous_tilt", kArcsec, UpTo(3600), List(s.asynchronous_tilt_rad), "the same about x and y");
  t.Text("vibration", &s.vibration,
         {"auto", "none", "VC-A", "VC-B", "VC-C", "VC-D", "VC-E", "VC-F", "VC-G", "listed"},
         "of the floor; auto: VC-E under bodies by Bullet, else none");
  t.Add("vibration_frequency", kHz, Positive(1e4), &s.vibration_frequency_Hz, "listed: centres of third octaves");
  t.Add("vibration_velocity", {"um_s", units::um}, UpTo(1e6), &s.vibration_velocity_m_s,
        "listed: rms in each of them");
}

void AddPlan(Table& t, ProcedureSettings& s) {
  t.Text("phases", &s.phases, {"calibration", "stability", "verification", "full_circle"},
         "in the order of the run");
  t.Add("positions", kPure, {3, 100000}, &s.positions, "measuring positions of the full circle");
  t.Add("shifts", kPure, UpTo(99999), &s.shifts, "index offset of the reference in every mounting, in measuring positions");
  t.Add("passes", kPure, {-1, 1}, &s.passes, "directions: 1 or -1");
  t.Text("clamping", &s.clamping, {"reseat", "reclamp"}, "how the grating returns to the PSDs: whole table re-mounted, turned (reseat); remounted on the rotor (reclamp)");
  t.Add("dwell", kSecond, UpTo(86400), &s.dwell_s, "drawn at random from this list at every measuring position");
  t.Add("run_up_steps", kPure, UpTo(1000), &s.run_up_steps, "every pass comes to its first measuring position from this far");
  t.Add("remount", kSecond, UpTo(1e7), &s.remount_s, "time that a re-mounting takes");
}

void AddProcedure(Keys& keys, ProcedureSettings& s) {
  Table t(keys, "procedure");
  AddPlan(t, s);
  t.Add("sweep", kArcsec, Positive(36000), &s.sweep_rad, "calibration: ± this, in yaw and in tilt");
  t.Add("sweep_points", kPure, {3, 10000}, &s.sweep_points, "of each sweep");
  t.Add("stability", kSecond, UpTo(1e8), &s.stability_s, "how long the bench is watched at rest");
  t.Add("stability_interval", kSecond, Positive(1e7), &s.stability_interval_s, "between its readings");
  t.Add("verification_points", kPure, {1, 10000}, &s.verification_points, "within the sweep, at other angles");
  t.Flag("keep_raw", s.keep_raw, "store every sample");
}

void CheckScanList(const ScenarioText& text, const AdcSettings& adc) {
  const std::set<std::string> once(adc.scan_list.begin(), adc.scan_list.end());
  if (once.size() == kChannelNames.size() && adc.scan_list.size() == kChannelNames.size()) return;
  throw InputError(Place(text, "adc.scan_list"),
                   fmt::format("adc.scan_list names {} of the {} channels in {} entries", once.size(),
                               kChannelNames.size(), adc.scan_list.size()),
                   "every channel once");
}

void CheckShifts(const ScenarioText& text, const ProcedureSettings& procedure) {
  const std::string where = Place(text, "procedure.shifts", "procedure.positions");
  const std::vector<int>& shifts = procedure.shifts;
  for (const int shift : shifts) {
    if (shift >= procedure.positions)
      throw InputError(where, fmt::format("procedure.shifts has {}", shift),
                       fmt::format("shifts from 0 to {} (positions - 1)", procedure.positions - 1));
    if (std::count(shifts.begin(), shifts.end(), shift) > 1)
      throw InputError(where, fmt::format("procedure.shifts has {} twice", shift), "every shift once");
  }
}

void CheckEncoders(const ScenarioText& text, const MechanicsSettings& m) {
  for (const double error_rad : m.encoder_subdivision_rad) {
    if (std::abs(error_rad) * m.encoder_periods < 0.9) continue;
    throw InputError(Place(text, "mechanics.encoder_subdivision_arcsec", "mechanics.encoder_periods"),
                     fmt::format("a subdivision error of {:.3g} arcsec turns a graduation of {} periods back",
                                 error_rad / units::arcsec, m.encoder_periods),
                     fmt::format("less than {:.3g} arcsec", 0.9 / m.encoder_periods / units::arcsec));
  }
}

void CheckWidths(const ScenarioText& text, const ChainSettings& chain) {
  if (chain.dnl_lsb > 0.0 && !chain.dnl_file.empty())
    throw InputError(Place(text, "adc.dnl_file", "adc.dnl_lsb"),
                     "both adc.dnl_file and adc.dnl_lsb say how wide codes are", "one of them");
}

void AddProbes(Keys& keys, ProbeSettings& s) {
  Table t(keys, "probes");
  t.Add("angles", kDeg, Within(360), &s.angles_rad, "where radial displacement probes stand, counter-clockwise");
  t.Add("reversed_mounting", kPure, {-1, 100000}, &s.reversed_mounting,
        "in which artefact and probes were turned by half a turn; -1: none");
}

void CheckVibration(const ScenarioText& text, const MechanicsSettings& m) {
  if (m.vibration_frequency_Hz.size() == m.vibration_velocity_m_s.size()) return;
  throw InputError(Place(text, "mechanics.vibration_velocity_um_s", "mechanics.vibration_frequency_Hz"),
                   fmt::format("{} frequencies and {} velocities", m.vibration_frequency_Hz.size(),
                               m.vibration_velocity_m_s.size()),
                   "one velocity for each frequency");
}

void CheckStability(const ScenarioText& text, const ProcedureSettings& procedure) {
  constexpr double kMostReadings = 1e7;
  const double readings = procedure.stability_s / procedure.stability_interval_s;
  if (readings <= kMostReadings) return;
  throw InputError(Place(text, "procedure.stability_s", "procedure.stability_interval_s"),
                   fmt::format("{:.6g} s of stability every {:.6g} s are {:.3g} readings", procedure.stability_s,
                               procedure.stability_interval_s, readings),
                   fmt::format("at most {:.0f}", kMostReadings));
}

void CheckProfile(const ScenarioText& text, const LaserSettings& laser) {
  if (laser.beam == "profile" && laser.profile_file.empty())
    throw InputError(Place(text, "laser.beam"), "laser.beam is \"profile\" without a file",
                     "laser.profile_file = \"beam.exr\"");
}

}  // namespace

void AddKeys(Keys& keys, Scenario& s) {
  RotarySettings& own = RotaryOf(s);
  AddLaser(keys, own.laser);
  AddGrating(keys, own.grating);
  AddOptics(keys, own.optics);
  AddPsd(keys, "psd_a", own.psd_a);
  AddPsd(keys, "psd_b", own.psd_b);
  AddAmplifier(keys, own.amplifier, own.chain);
  AddAdc(keys, own.adc, own.chain);
  AddTable(keys, "target", "in L", own.target);
  AddReferenceMounting(keys, s);
  AddTable(keys, "reference", "in its rotor frame", own.reference);
  AddMechanics(keys, own.mechanics);
  AddDrives(keys, own.mechanics);
  AddRestlessness(keys, own.mechanics);
  AddEnvironment(keys, s.environment);
  AddAutocollimator(keys, own.autocollimator);
  AddProbes(keys, own.probes);
  AddProcedure(keys, own.procedure);
}

void CheckTogether(const ScenarioText& text, const Scenario& s) {
  const RotarySettings& own = RotaryOf(s);
  CheckScanList(text, own.adc);
  CheckShifts(text, own.procedure);
  CheckPasses(text, "procedure.passes", own.procedure.passes);
  CheckStability(text, own.procedure);
  CheckProfile(text, own.laser);
  CheckEncoders(text, own.mechanics);
  CheckVibration(text, own.mechanics);
  CheckWidths(text, own.chain);
}

}  // namespace twinbench::benches::rotary
