#include "tests/own_scenario/own_scenario.h"
#include "twin/benches/names.h"

namespace twinbench::own_circular {
namespace {

using test::Change, test::OwnKey;

/// Both axes.
void AddPair(const std::string& key, const std::string& unit, const std::string& value, std::vector<OwnKey>& keys) {
  keys.push_back(Change(key + "_x" + unit, value));
  keys.push_back(Change(key + "_y" + unit, value));
}

std::vector<OwnKey> MachineChanges() {
  std::vector<OwnKey> keys = {Change("machine.squareness_arcsec", "9.0"),
                              Change("machine.noise_um", "0.4"),
                              Change("machine.span_mm", "150.0", {"machine.straightness_x_um=3.0"}),
                              Change("machine.cyclic_pitch_mm", "20.0"),
                              Change("machine.spike_time_s", "0.3"),
                              Change("machine.cyclic_phase_x_deg", "70.0"),
                              Change("machine.cyclic_phase_y_deg", "70.0", {"machine.cyclic_y_um=0.5"})};
  AddPair("machine.lag", "_s", "0.003", keys);
  AddPair("machine.scale", "_um_m", "-40.0", keys);
  AddPair("machine.straightness", "_um", "-2.0", keys);
  AddPair("machine.straightness3", "_um", "2.0", keys);
  AddPair("machine.backlash", "_um", "5.0", keys);
  AddPair("machine.spike", "_um", "5.0", keys);
  AddPair("machine.cyclic", "_um", "1.0", keys);
  AddPair("machine.expansion", "_um_m_K", "11.0", keys);
  AddPair("machine.drift", "_um_K", "2.0", keys);
  return keys;
}

std::vector<OwnKey> InstrumentChanges() {
  const std::vector<std::string> high = {"bar.height_mm=3.0"};
  std::vector<OwnKey> keys = {Change("bar.noise_um", "0.5"),
                              Change("bar.resolution_um", "1.0"),
                              Change("bar.height_mm", "3.0"),
                              Change("bar.length_error_um", "30.0"),
                              Change("bar.gain_error", "0.01"),
                              Change("bar.cubic_per_mm2", "5.0"),
                              Change("bar.ball2_um", "0.5"),
                              Change("bar.ball2_azimuth_deg", "30.0", {"bar.ball2_um=0.5"}),
                              Change("bar.ball3_um", "0.5"),
                              Change("bar.ball3_azimuth_deg", "-30.0"),
                              Change("bar.expansion_um_m_K", "5.0"),
                              Change("bar.latency_s", "0.002"),
                              Change("encoder.noise_arcsec", "0.5"),
                              Change("encoder.lines", "3600"),
                              Change("encoder.interpolation", "400"),
                              Change("encoder.zero_deg", "12.0"),
                              Change("encoder.tilt_x_mrad", "1.0", high),
                              Change("encoder.tilt_y_mrad", "-2.0", high),
                              Change("encoder.eccentricity_arcsec", "15.0"),
                              Change("encoder.eccentricity_azimuth_deg", "-60.0"),
                              Change("encoder.ellipticity_arcsec", "3.0"),
                              Change("encoder.ellipticity_azimuth_deg", "80.0"),
                              Change("encoder.latency_s", "0.002"),
                              Change("grid.noise_um", "0.3"),
                              Change("grid.period_um", "20.0", {"grid.sde_nm=500"}),
                              Change("grid.rotation_arcsec", "900.0"),
                              Change("grid.shear_arcsec", "5.0"),
                              Change("grid.sde_nm", "50.0")};
  AddPair("bar.offset", "_um", "200.0", keys);
  AddPair("grid.scale", "_um_m", "20.0", keys);
  AddPair("grid.offset", "_um", "300.0", keys);
  return keys;
}

/// Axes as bodies, on few circles; the closed form's own words are taken back.
std::vector<OwnKey> BodyChanges() {
  const std::vector<std::string> few = {
      "machine.lag_y_s=0.001",
      "machine.backlash_x_um=0",
      "machine.backlash_y_um=0",
      "machine.spike_x_um=0",
      "machine.spike_y_um=0",
      "circular_procedure.feeds_mm_min=[1000.0]",
      R"(circular_procedure.setups=[{instrument="bar", radius_mm=110.23}, {instrument="grid", radius_mm=110.23}])"};
  std::vector<OwnKey> keys = {Change("mechanics.fidelity", "\"bullet\"", few)};
  std::vector<std::string> bodies = few;
  bodies.push_back("mechanics.fidelity=\"bullet\"");
  const auto add = [&](const std::string& key, const std::string& value) {
    keys.push_back(Change("drives." + key, value, bodies));
  };
  for (const std::string axis : {"x", "y"}) {
    add("mass_" + axis + "_kg", "500");
    add("screw_inertia_" + axis + "_kg_m2", "6e-3");
    add("lead_" + axis + "_mm", "20");
    add("stiffness_" + axis + "_N_um", "80");
    add("torsion_" + axis + "_Nm_rad", "3000");
    add("play_" + axis + "_um", "2");
    add("friction_" + axis + "_N", "400");
    add("viscous_" + axis + "_N_s_m", "8000");
    add("position_gain_" + axis + "_per_s", "40");
    add("velocity_gain_" + axis + "_per_s", "200");
    add("integral_time_" + axis + "_s", "0.04");
    add("feed_forward_" + axis, "0.5");
  }
  add("damping_ratio", "0.2");
  add("static_ratio", "1.6");
  add("stribeck_mm_s", "5");
  add("presliding_um", "10");
  add("encoder", "\"slide\"");
  add("ramp_s", "0.2");
  add("servo_period_us", "250");
  add("step_us", "100");
  return keys;
}

std::vector<OwnKey> ProcedureChanges() {
  return {Change("mounting.offset_um", "200.0"),
          Change("mounting.zero_deg", "2.0"),
          Change("mounting.length_um", "100.0"),
          Change("mounting.grid_rotation_arcsec", "2000.0"),
          Change("circular_procedure.setups",
                 R"([{instrument="bar", radius_mm=80.0}, {instrument="grid", radius_mm=80.0}])"),
          Change("circular_procedure.feeds_mm_min", "[500.0, 2000.0]"),
          Change("circular_procedure.points", "40"),
          Change("circular_procedure.stops", "0"),
          Change("circular_procedure.dwell_s", "9.0"),
          Change("circular_procedure.rapid_mm_min", "5000.0"),
          Change("circular_procedure.directions", "[1]"),
          Change("circular_procedure.start_deg", "77.0"),
          Change("circular_procedure.remount_s", "60.0"),
          Change("environment.temperature_degC", "22.0"),
          Change("environment.reference_degC", "19.0"),
          Change("environment.drift_K_h", "1.0"),
          Change("environment.swing_mK", "3000.0"),
          Change("environment.swing_period_s", "3000.0"),
          Change("environment.random_walk_K_sqrt_h", "0.5"),
          Change("environment.sensor_noise_mK", "5.0")};
}

std::vector<OwnKey> Keys() {
  std::vector<OwnKey> all = {
      {"bench", {}, "another bench"},
      {"title", {}, "words"},
      {"seed", {}, "every run has its own"},
      {"repeat", {"repeat=3"}},
      {"noise_free", {"noise_free=true"}},
      {"environment.temperature_file", {}, "read by another test of the room's temperature"}};
  for (const auto& part : {MachineChanges(), BodyChanges(), InstrumentChanges(), ProcedureChanges()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

const std::vector<std::string> kBase = {"circular_procedure.points=24", "circular_procedure.stops=8"};

}  // namespace

test::OwnBench Bench() {
  return {kCircularBench, "circular_machining_centre.toml", kBase, Keys(), kBase, 20};
}

}  // namespace twinbench::own_circular
