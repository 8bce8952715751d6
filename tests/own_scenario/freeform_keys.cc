#include "tests/own_scenario/own_scenario.h"
#include "twin/benches/names.h"

namespace twinbench::own_freeform {
namespace {

using test::Change, test::OwnKey;

std::vector<OwnKey> MachineChanges() {
  std::vector<OwnKey> keys = {Change("machine.pivot_mm", "80.0"), Change("machine.random.translation_um", "8.0"),
                              Change("machine.random.rotation_arcsec", "5.0"),
                              Change("machine.random.squareness_arcsec", "12.0")};
  for (const char* squareness : {"syx", "szx", "szy", "say", "saz", "sbx", "sbz"})
    keys.push_back(Change(std::string("machine.") + squareness + "_arcsec", "-20.0"));
  for (const char* axis : {"x", "y", "z", "a", "b"}) {
    const std::string name = std::string("machine.") + axis, unit = *axis < 'x' ? "_deg" : "_mm";
    keys.push_back(Change(name + "_centre" + unit, "3.0"));
    keys.push_back(Change(name + "_half" + unit, *axis < 'x' ? "9.0" : "200.0"));
    for (const char* error : {"tx_um", "ty_um", "tz_um", "rx_arcsec", "ry_arcsec", "rz_arcsec"})
      keys.push_back(Change(name + "." + error, "[8.0, -8.0, 4.0, 4.0]"));
  }
  return keys;
}

// A probe that the closed form does not know is traced at every ask of a diagnosis.
const std::string kFew = "freeform_procedure.poses=16";

std::vector<OwnKey> ProbeChanges() {
  return {Change("artefact.vertex_radius_mm", "[50.0, 90.0]"),
          Change("artefact.pitch_mm", "25.0"),
          Change("artefact.cells", "4"),
          Change("artefact.mounting_um", "60.0"),
          Change("artefact.mounting_arcsec", "60.0"),
          Change("qpd.lens_mm", "40.0"),
          Change("qpd.spot_radius_mm", "0.35"),
          Change("qpd.gap_mm", "0.05"),
          Change("qpd.sum_V", "8.0"),
          Change("qpd.noise_mV", "30.0"),
          Change("ccd.object_mm", "80.0"),
          Change("ccd.image_mm", "50.0"),
          Change("ccd.alpha_deg", "40.0"),
          Change("ccd.pixel_um", "5.0"),
          Change("ccd.centre_px", "900.0"),
          Change("ccd.noise_px", "0.2"),
          Change("optics.fidelity", "\"closed\""),
          {"optics.spot", {"optics.spot=\"beam\"", "optics.beam_radius_mm=0.12", "optics.wavelength_nm=850", kFew}},
          {"optics.beam_radius_mm", {}, "tried with optics.spot"},
          {"optics.wavelength_nm", {}, "tried with optics.spot"},
          // Everything that leaks at once: a diagnosis of each alone takes several seconds of tracing.
          {"optics.plate_reflected",
           {"optics.plate_reflected=0.002", "optics.plate_tilt_x_mrad=2.0", "optics.plate_tilt_y_mrad=-1.0",
            "optics.plate_retardance_deg=10.0", "optics.plate_azimuth_deg=5.0", "optics.splitter=\"stack\"",
            "optics.splitter_p_reflected=0.02", "optics.splitter_s_transmitted=0.02", kFew}},
          {"optics.plate_tilt_x_mrad", {}, "tried with optics.plate_reflected"},
          {"optics.plate_tilt_y_mrad", {}, "tried with optics.plate_reflected"},
          {"optics.plate_retardance_deg", {}, "tried with optics.plate_reflected"},
          {"optics.plate_azimuth_deg", {}, "tried with optics.plate_reflected"},
          {"optics.splitter", {}, "tried with optics.plate_reflected"},
          {"optics.splitter_p_reflected", {}, "tried with optics.plate_reflected"},
          {"optics.splitter_s_transmitted", {}, "tried with optics.plate_reflected"}};
}

std::vector<OwnKey> ProcedureChanges() {
  return {Change("freeform_procedure.mounts", "[{x_mm=10.0, yaw_deg=45.0}, {z_mm=80.0}, {z_mm=160.0}]"),
          Change("freeform_procedure.poses", "40"),
          Change("freeform_procedure.angle_deg", "8.0"),
          Change("freeform_procedure.height_mm", "3.0"),
          Change("freeform_procedure.dither_um", "50.0"),
          Change("freeform_procedure.dither_deg", "0.02"),
          Change("freeform_procedure.path", "\"single\""),
          Change("freeform_procedure.interval_s", "60.0"),
          Change("freeform_procedure.remount_s", "60.0"),
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
      {"artefact.form_error", {}, "a picture of heights, in the tests of the bench"},
      {"environment.temperature_file", {}, "read by another test of the room's temperature"}};
  for (const auto& part : {MachineChanges(), ProbeChanges(), ProcedureChanges()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

const std::vector<std::string> kBase = {"freeform_procedure.poses=32"};

}  // namespace

test::OwnBench Bench() {
  return {kFreeformBench, "freeform_five_axis.toml", kBase, Keys(), kBase, 20};
}

}  // namespace twinbench::own_freeform
