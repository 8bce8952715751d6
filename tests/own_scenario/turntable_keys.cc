#include "tests/own_scenario/own_scenario.h"
#include "twin/benches/names.h"

namespace twinbench::own_turntable {
namespace {

const std::vector<std::string>& Base() {
  static const std::vector<std::string> base = {
      "turntable_procedure.phases=[\"calibration\", \"full_circle\"]", "turntable_procedure.positions=24",
      "turntable_procedure.passes=[1, -1, -1, 1]", "turntable_procedure.eccentricities_um=[50.0, 1500.0]",
      "turntable_procedure.dwell_s=[0.5, 2.0, 5.0]"};
  return base;
}

const char* const kWave =
    "[{component=\"ez\", order=3, amplitude_arcsec=30, phase_deg=20}, {component=\"ex\", order=1, "
    "amplitude_arcsec=20, phase_deg=50}, {component=\"dx\", order=2, amplitude_um=50, phase_deg=0}]";
const char* const kWarm = "autocollimator.x_per_kelvin_arcsec=5";

std::vector<test::OwnKey> Keys() {
  const std::string wave = kWave;
  std::vector<test::OwnKey> all = {
      {"bench", {}, "another bench"},
      {"title", {}, "words"},
      {"seed", {"seed=77"}},
      {"repeat", {"repeat=3"}},
      {"noise_free", {"noise_free=true"}},
      {"multitooth.teeth", {"multitooth.teeth=720"}},
      {"multitooth.tooth_rms_arcsec", {"multitooth.tooth_rms_arcsec=2"}},
      {"multitooth.u_tooth_arcsec", {"multitooth.u_tooth_arcsec=2"}},
      {"multitooth.index_time_s", {"multitooth.index_time_s=20"}},
      {"mechanics.fidelity", {"mechanics.fidelity=linear"}},
      {"mirror.width_mm", {"mirror.width_mm=25"}},
      {"mirror.height_mm", {"mirror.height_mm=22"}},
      {"mirror.flatness_nm", {"mirror.flatness_nm=6000"}},
      {"mirror.radius_mm", {"mirror.radius_mm=300"}},
      {"autocollimator.noise_arcsec", {"autocollimator.noise_arcsec=2"}},
      {"autocollimator.frames", {"autocollimator.frames=16"}},
      {"autocollimator.frame_s",
       {"autocollimator.frame_s=2", "autocollimator.frames=5", "environment.drift_K_h=2", kWarm}},
      {"autocollimator.range_arcsec",
       {"autocollimator.range_arcsec=1000", "autocollimator.error_at_edge_arcsec=50"}},
      {"autocollimator.gain_error", {"autocollimator.gain_error=0.1"}},
      {"autocollimator.distance_mm", {"autocollimator.distance_mm=900"}},
      {"autocollimator.focal_length_mm", {"autocollimator.focal_length_mm=600"}},
      {"autocollimator.aperture_mm", {"autocollimator.aperture_mm=70"}},
      {"autocollimator.roll_mrad", {"autocollimator.roll_mrad=150"}},
      {"autocollimator.error_at_edge_arcsec", {"autocollimator.error_at_edge_arcsec=20"}},
      {"autocollimator.pixel_pitch_um",
       {"autocollimator.pixel_pitch_um=9", "autocollimator.interpolation_error_px=0.1"}},
      {"autocollimator.interpolation_error_px", {"autocollimator.interpolation_error_px=0.15"}},
      {"autocollimator.x_per_kelvin_arcsec", {"autocollimator.x_per_kelvin_arcsec=5", "environment.drift_K_h=2"}},
      {"autocollimator.y_per_kelvin_arcsec", {"autocollimator.y_per_kelvin_arcsec=5", "environment.drift_K_h=2"}},
      {"environment.temperature_degC", {"environment.temperature_degC=25", kWarm}},
      {"environment.reference_degC", {"environment.reference_degC=25", kWarm}},
      {"environment.drift_K_h", {"environment.drift_K_h=-5", kWarm}},
      {"environment.swing_mK", {"environment.swing_mK=2000", kWarm}},
      {"environment.swing_period_s", {"environment.swing_period_s=700", "environment.swing_mK=2000", kWarm}},
      {"environment.random_walk_K_sqrt_h", {"environment.random_walk_K_sqrt_h=2", kWarm}},
      {"environment.temperature_file", {}, "as the other kinds of temperature: it is logged"},
      {"environment.sensor_noise_mK", {"environment.sensor_noise_mK=300", kWarm}},
      {"turntable_procedure.phases",
       {"turntable_procedure.phases=[\"verification\", \"full_circle\", \"calibration\"]"}},
      {"turntable_procedure.positions", {"turntable_procedure.positions=36"}},
      {"turntable_procedure.tilts_arcsec", {"turntable_procedure.tilts_arcsec=[250, -200]"}},
      {"turntable_procedure.tilt_azimuths_deg", {"turntable_procedure.tilt_azimuths_deg=[-100, 60]"}},
      {"turntable_procedure.shifts_teeth", {"turntable_procedure.shifts_teeth=[15, 90]"}},
      {"turntable_procedure.eccentricities_um", {"turntable_procedure.eccentricities_um=[8000, -8000]"}},
      {"turntable_procedure.remount_s", {"turntable_procedure.remount_s=7200"}},
      {"turntable_procedure.passes", {"turntable_procedure.passes=[-1, 1, 1]"}},
      {"turntable_procedure.dwell_s", {"turntable_procedure.dwell_s=[0, 20]"}},
      {"turntable_procedure.run_up_steps", {"turntable_procedure.run_up_steps=0", "turntable.backlash_arcsec=5"}},
      {"turntable_procedure.sweep_arcsec", {"turntable_procedure.sweep_arcsec=350"}},
      {"turntable_procedure.sweep_points", {"turntable_procedure.sweep_points=31"}},
      {"turntable_procedure.verification_positions",
       {"turntable_procedure.verification_positions=30",
        "turntable_procedure.phases=[\"full_circle\", \"verification\"]"}},
      {"turntable_procedure.verification_passes",
       {"turntable_procedure.verification_passes=[-1, 1]",
        "turntable_procedure.phases=[\"full_circle\", \"verification\"]",
        "turntable_procedure.verification_positions=30"}},
  };
  const auto add_polygon = [&](const std::string& key, const std::vector<std::string>& more = {}) {
    all.push_back({key,
                   {"polygon.faces=24", "turntable_procedure.phases=[\"full_circle\"]",
                    "turntable_procedure.polygon_offsets_deg=[0, 40]", "autocollimator.noise_arcsec=0.05"}});
    all.back().settings.insert(all.back().settings.end(), more.begin(), more.end());
  };
  add_polygon("polygon.faces");
  add_polygon("polygon.face_errors_arcsec", {"polygon.face_errors_arcsec=[3]"});
  add_polygon("polygon.face_rms_arcsec", {"polygon.face_rms_arcsec=3"});
  add_polygon("polygon.pyramid_rms_arcsec", {"polygon.pyramid_rms_arcsec=5"});
  add_polygon("encoder.noise_arcsec", {"encoder.noise_arcsec=0.1"});
  add_polygon("encoder.step_arcsec", {"encoder.step_arcsec=0.05", "encoder.noise_arcsec=0.03"});
  add_polygon("autocollimator.deadband_arcsec", {"autocollimator.deadband_arcsec=20"});
  add_polygon("turntable_procedure.polygon_offsets_deg", {"turntable_procedure.polygon_offsets_deg=[7, 350]"});
  all.push_back({"turntable_procedure.highest_order", {}, "of the evaluation alone"});
  all.push_back({"turntable.compensation_file", {}, "its content is in turntable.compensation"});
  all.push_back({"turntable.compensation",
                 {"turntable.compensation={position_deg=[0, 90, 180, 270], correction_arcsec=[0, 20, -5, 8]}"}});
  for (const std::string table : {"turntable", "multitooth"}) {
    const auto add = [&](const std::string& name, const std::vector<std::string>& settings,
                         const std::string& reason = {}) {
      all.push_back({table + "." + name, settings, reason});
    };
    const auto set = [&](const std::string& name, const std::string& value) {
      return table + "." + name + "=" + value;
    };
    add("harmonics", {set("harmonics", wave)});
    add("errors_file", {}, "free, as harmonics are");
    add("errors", {}, "the content of errors_file");
    add("half_frequency_order", {set("half_frequency_order", "0.4"), set("half_frequency_tilt_arcsec", "10")});
    add("half_frequency_tilt_arcsec", {set("half_frequency_tilt_arcsec", "10")});
    add("half_frequency_radial_um", {set("half_frequency_radial_um", "100"), "mirror.flatness_nm=6000"});
    add("backlash_arcsec", {set("backlash_arcsec", "10")});
    add("speed_deg_s", {set("speed_deg_s", "10")});
    add("move_time_s", {set("move_time_s", "12")});
    add("settle_s", {set("settle_s", "8")});
    add("random.orders", {set("random.orders", "30"), set("random.ez_arcsec", "5")});
    for (const char* angle : {"ex", "ey", "ez"}) {
      const std::string key = std::string(angle) + "_arcsec";
      add("random." + key, {set("random." + key, "10")});
      add("seating." + key, {set("seating." + key, "20")});
      add("repeatability." + key, {set("repeatability." + key, "2")});
    }
    for (const char* length : {"dx", "dy", "dz"}) {
      const std::string key = std::string(length) + "_um";
      const std::string bent = "mirror.flatness_nm=6000";  // else a shift shows nothing
      add("random." + key, {set("random." + key, "200"), bent});
      add("seating." + key, {set("seating." + key, "500"), bent});
      add("repeatability." + key, {set("repeatability." + key, "200"), bent});
    }
  }
  return all;
}

}  // namespace

test::OwnBench Bench() {
  return {kTurntableBench, "turntable_autocollimator.toml", Base(), Keys(), Base(), 50};
}

}  // namespace twinbench::own_turntable
