#include "tests/own_scenario/own_scenario.h"
#include "twin/benches/names.h"

namespace twinbench::own_hob {
namespace {

const std::vector<std::string>& Base() {
  static const std::vector<std::string> base = {
      "mechanics.fidelity=kinematic", "hob_procedure.hob_speeds_rev_min=[50.0, 25.0]", "hob_procedure.turns=1",
      "hob_procedure.samples_per_turn=240", "hob_procedure.poll_s=10.0"};
  return base;
}

const char* const kLines =
    "[{order=2, amplitude_arcsec=5, phase_deg=20}, {order=7, amplitude_arcsec=3, phase_deg=50}, "
    "{order=61, amplitude_arcsec=1, phase_deg=0}]";

std::vector<test::OwnKey> Keys() {
  const std::string lines = kLines;
  std::vector<test::OwnKey> all = {
      {"bench", {}, "another bench"},
      {"title", {}, "words"},
      {"seed", {"seed=77"}},
      {"repeat", {"repeat=3"}},
      {"noise_free", {"noise_free=true"}},
      {"transmission.hob_starts", {"transmission.hob_starts=1"}},
      {"transmission.gear_teeth", {"transmission.gear_teeth=60"}},
      {"transmission.worm_wheel_teeth", {"transmission.worm_wheel_teeth=120"}},
      {"transmission.worm_starts", {"transmission.worm_starts=2"}},
      {"transmission.harmonics", {"transmission.harmonics=" + lines}},
      {"transmission.free_orders", {"transmission.free_orders=0"}},
      {"transmission.servo_Hz", {"transmission.servo_Hz=2", "transmission.feed_forward=0.9"}},
      {"transmission.feed_forward", {"transmission.feed_forward=0.9"}},
      {"transmission.table_inertia_kg_m2", {"transmission.table_inertia_kg_m2=200", "mechanics.fidelity=bullet"}},
      {"transmission.stiffness_Nm_mrad", {"transmission.stiffness_Nm_mrad=1000"}},
      {"transmission.damping_ratio", {"transmission.damping_ratio=0.5", "mechanics.fidelity=bullet"}},
      {"transmission.friction_Nm", {"transmission.friction_Nm=1000"}},
      {"transmission.backlash_arcsec", {"transmission.backlash_arcsec=30"}},
      {"transmission.compensation_file", {}, "its content is in transmission.compensation"},
      {"transmission.compensation",
       {"transmission.compensation={position_deg=[0, 90, 180, 270], correction_arcsec=[0, 20, -5, 8]}"}},
      {"interferometer.used", {"interferometer.used=false"}},
      {"interferometer.noise_arcsec", {"interferometer.noise_arcsec=1"}},
      {"interferometer.misalignment_mrad", {"interferometer.misalignment_mrad=100"}},
      {"interferometer.arm_mm", {"interferometer.arm_mm=10", "interferometer.arm_error_um=200"}},
      {"interferometer.arm_error_um", {"interferometer.arm_error_um=500"}},
      {"interferometer.dead_path_mm", {"interferometer.dead_path_mm=500", "interferometer.index_drift_ppm_h=5"}},
      {"interferometer.index_drift_ppm_h",
       {"interferometer.index_drift_ppm_h=-5", "interferometer.dead_path_mm=500"}},
      {"interferometer.stops", {"interferometer.stops=24"}},
      {"interferometer.u_calibrator_arcsec", {"interferometer.u_calibrator_arcsec=1"}},
      {"interferometer.calibrator",
       {"interferometer.calibrator=[{order=1, amplitude_arcsec=2.0}, {order=4, amplitude_arcsec=0.5}]"}},
      {"mechanics.fidelity", {"mechanics.fidelity=bullet"}},
      {"hob_procedure.heads_deg", {"hob_procedure.heads_deg=[-100, 45, 200]"}},
      {"hob_procedure.encoder_zero", {"hob_procedure.encoder_zero=reference_mark"}},
      {"hob_procedure.hob_speeds_rev_min", {"hob_procedure.hob_speeds_rev_min=[100, 10]"}},
      {"hob_procedure.passes", {"hob_procedure.passes=[-1, -1, 1]"}},
      {"hob_procedure.turns", {"hob_procedure.turns=2"}},
      {"hob_procedure.samples_per_turn", {"hob_procedure.samples_per_turn=180"}},
      {"hob_procedure.ramp_s", {"hob_procedure.ramp_s=6"}},
      {"hob_procedure.rest_s", {"hob_procedure.rest_s=20"}},
      {"hob_procedure.remount_s", {"hob_procedure.remount_s=100"}},
      {"hob_procedure.fifo_samples", {"hob_procedure.fifo_samples=4000"}},
      {"hob_procedure.poll_s", {"hob_procedure.poll_s=3"}},
  };
  for (const std::string ring : {"table_encoder", "hob_encoder"}) {
    const auto add = [&](const std::string& name, const std::string& value, std::vector<std::string> more = {}) {
      std::vector<std::string> settings = {ring + "." + name + "=" + value};
      for (const std::string& setting : more) settings.push_back(ring + "." + setting);
      all.push_back({ring + "." + name, settings});
    };
    add("lines", ring == "table_encoder" ? "36000" : "5000");
    add("radius_mm", "40", {"eccentricity_um=5"});
    add("eccentricity_um", "30");
    add("eccentricity_azimuth_deg", "-70", {"eccentricity_um=30"});
    add("tilt_arcsec", "500", {"head_height_mm=20"});
    add("tilt_azimuth_deg", "120", {"tilt_arcsec=500", "head_height_mm=20"});
    add("head_height_mm", "-20", {"tilt_arcsec=500"});
    add("ellipticity_um", "20");
    add("ellipticity_azimuth_deg", "50", {"ellipticity_um=20"});
    add("graduation", lines);
    add("interpolation", "7");
    add("noise_arcsec", "2");
  }
  return all;
}

}  // namespace

test::OwnBench Bench() {
  return {kHobBench, "hob_transmission.toml", Base(), Keys(), Base(), 50};
}

}  // namespace twinbench::own_hob
