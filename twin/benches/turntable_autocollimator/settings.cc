#include "twin/benches/turntable_autocollimator/settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "twin/benches/turntable_autocollimator/format.h"
#include "twin/core/errors.h"
#include "twin/core/scenario_together.h"
#include "twin/core/schema_table.h"

namespace twinbench::benches::turntable {
namespace {

using namespace schema;

constexpr int kFewestFaces = 3;

void AddMultitooth(Keys& keys, MultitoothSettings& s) {
  Table t(keys, "multitooth");
  t.Add("teeth", kPure, {3, 100000}, &s.teeth, "per turn");
  t.Add("tooth_rms", kArcsec, UpTo(3600), &s.tooth_rms_rad,
        "of errors that differ from tooth to tooth; u is no less");
  t.Add("u_tooth", kArcsec, UpTo(3600), &s.u_tooth_rad, "stated standard uncertainty of a tooth");
  t.Add("index_time", kSecond, Positive(3600), &s.index_time_s, "to lift it, turn it and seat it again");
}

void AddPolygon(Keys& keys, PolygonSettings& s) {
  Table t(keys, "polygon");
  t.Add("faces", kPure, {0, 1000}, &s.faces,
        "that are nulled instead of indexing a multi-tooth table; 0: no polygon");
  t.Add("face_errors", kArcsec, Within(3600), &s.face_errors_rad,
        "of their angles, counter-clockwise, one a face or one for all");
  t.Add("face_rms", kArcsec, UpTo(3600), &s.face_rms_rad, "of errors drawn on top of them");
  t.Add("pyramid_rms", kArcsec, UpTo(3600), &s.pyramid_rms_rad, "of their tilts against the polygon's axis");
}

void AddEncoder(Keys& keys, TurntableEncoderSettings& s) {
  Table t(keys, "encoder");
  t.Add("noise", kArcsec, UpTo(3600), &s.noise_rad, "of a reading of the turntable's encoder");
  t.Add("step", kArcsec, UpTo(3600), &s.step_rad, "its least count");
}

void AddMirror(Keys& keys, MirrorSettings& s) {
  Table t(keys, "mirror");
  t.Add("width", kMm, Positive(1000), &s.width_m, "of the mirror");
  t.Add("height", kMm, Positive(1000), &s.height_m, "of the mirror");
  t.Add("flatness", kNm, Within(10000), &s.flatness_m, "sag over its width; positive: hollow");
  t.Add("radius", kMm, UpTo(5000), &s.radius_m, "its surface from the multi-tooth table's axis");
}

void AddCollimator(Keys& keys, CollimatorSettings& s) {
  Table t(keys, "autocollimator");
  t.Add("distance", kMm, Positive(50000), &s.distance_m, "of the objective from the turntable's axis");
  t.Add("focal_length", kMm, Positive(5000), &s.focal_length_m, "of the objective");
  t.Add("aperture", kMm, Positive(500), &s.aperture_m, "diameter of the objective");
  t.Add("roll", kMrad, Within(1000), &s.roll_rad, "of the crosshair: x' = x + y' sin(roll)");
  t.Add("error_at_edge", kArcsec, Within(1000), &s.error_at_edge_rad,
        "cube of the angle, at the edge of the range");
  t.Add("pixel_pitch", kUm, Positive(1000), &s.pixel_pitch_m, "of the camera");
  t.Add("interpolation_error", {"px"}, UpTo(0.5), &s.interpolation_error_px, "amplitude, repeats with the pixels");
  t.Add("x_per_kelvin", kArcsec, Within(100), &s.x_per_kelvin_rad, "zero of x, against environment.reference_degC");
  t.Add("y_per_kelvin", kArcsec, Within(100), &s.y_per_kelvin_rad, "zero of y, likewise");
  t.Add("deadband", kArcsec, Positive(3600), &s.deadband_rad, "x that its servo takes for zero (polygon)");
  t.Add("frames", kPure, {1, 100000}, &s.frames,
        "of its camera, whose mean is one reading; noise_arcsec is of one");
  t.Add("frame", kSecond, Positive(60), &s.frame_s, "from one of these to the next");
}

void AddSetUps(Table& t, TurntableProcedureSettings& s) {
  const std::string list = ", one per mounting or one for all";
  t.Add("tilts", kArcsec, Within(3600), &s.tilts_rad, "of the multi-tooth table's axis" + list);
  t.Add("tilt_azimuths", kDeg, Within(360), &s.tilt_azimuths_rad, "on the turntable, where it leans to" + list);
  t.Add("shifts_teeth", kPure, UpTo(99999), &s.shifts, "of the multi-tooth table" + list);
  t.Add("eccentricities", kUm, Within(10000), &s.eccentricities_m, "of its axis, along the azimuth" + list);
  t.Add("polygon_offsets", kDeg, Within(360), &s.polygon_offsets_rad,
        "of the turntable where the polygon's face 0 is seen" + list);
  t.Add("remount", kSecond, UpTo(1e7), &s.remount_s, "time that a mounting takes");
}

void AddTurntableProcedure(Keys& keys, TurntableProcedureSettings& s) {
  Table t(keys, "turntable_procedure");
  t.Text("phases", &s.phases, {"calibration", "full_circle", "verification"}, "in the order of the run");
  t.Add("positions", kPure, {3, 100000}, &s.positions, "of the full circle; a whole number of teeth apart");
  AddSetUps(t, s);
  t.Add("passes", kPure, {-1, 1}, &s.passes, "directions of the full circle: 1 or -1");
  t.Add("dwell", kSecond, UpTo(86400), &s.dwell_s, "drawn at random from this list at every measuring position");
  t.Add("highest_order", kPure, {1, 1000}, &s.highest_order, "of the error that is fitted to a polygon's faces");
  t.Add("run_up_steps", kPure, UpTo(1000), &s.run_up_steps, "every pass comes to its first measuring position from this far");
  t.Add("sweep", kArcsec, Positive(36000), &s.sweep_rad, "calibration: ± this, with the turntable alone");
  t.Add("sweep_points", kPure, {3, 10000}, &s.sweep_points, "of the sweep");
  t.Add("verification_positions", kPure, {1, 100000}, &s.verification_positions, "whole teeth off the grid");
  t.Add("verification_passes", kPure, {-1, 1}, &s.verification_passes, "directions: 1 or -1");
}

void AddMotionOfTheTurntable(Keys& keys, MechanicsSettings& s) {
  Table t(keys, "mechanics");
  t.Text("fidelity", &s.fidelity, {"kinematic", "linear", "bullet"}, "how the turntable moves");
}

/// What only a multi-tooth table can do is refused with a polygon, and the other way round.
void CheckPolygon(const ScenarioText& text, const Scenario& s) {
  const PolygonSettings& polygon = TurntableOf(s).polygon;
  const TurntableProcedureSettings& procedure = TurntableOf(s).turntable_procedure;
  const auto refuse = [&](const std::string& key, const std::string& problem, const std::string& expected) {
    throw InputError(Place(text, key), problem, expected);
  };
  if (polygon.faces == 0) {
    if (procedure.polygon_offsets_rad != std::vector{0.0})
      refuse("turntable_procedure.polygon_offsets_deg", "offsets of a polygon, but there is none", "polygon.faces");
    return;
  }
  if (polygon.faces < kFewestFaces)
    refuse("polygon.faces", fmt::format("a polygon of {} faces", polygon.faces),
           fmt::format("{} or more, or 0 for none", kFewestFaces));
  if (polygon.faces % procedure.positions != 0)
    refuse("turntable_procedure.positions",
           fmt::format("{} positions are no whole number of faces apart", procedure.positions),
           fmt::format("a divisor of the {} faces", polygon.faces));
  const std::size_t errors = polygon.face_errors_rad.size();
  if (errors != 1 && errors != static_cast<std::size_t>(polygon.faces))
    refuse("polygon.face_errors_arcsec", fmt::format("{} errors for {} faces", errors, polygon.faces),
           fmt::format("1 or {}", polygon.faces));
  if (procedure.phases != std::vector<std::string>{"full_circle"})
    refuse("turntable_procedure.phases", "a phase that a polygon is not nulled in", "phases = [\"full_circle\"]");
  if (procedure.shifts != std::vector{0})
    refuse("turntable_procedure.shifts_teeth", "shifts of a multi-tooth table with a polygon",
           "turntable_procedure.polygon_offsets_deg");
}

void CheckTeeth(const ScenarioText& text, const Scenario& s) {
  const int teeth = TurntableOf(s).multitooth.teeth;
  const TurntableProcedureSettings& procedure = TurntableOf(s).turntable_procedure;
  if (teeth % procedure.positions != 0)
    throw InputError(Place(text, "turntable_procedure.positions"),
                     fmt::format("{} positions are no whole number of teeth apart", procedure.positions),
                     fmt::format("a divisor of the {} teeth", teeth));
  for (const int shift : procedure.shifts) {
    if (shift >= teeth)
      throw InputError(Place(text, "turntable_procedure.shifts_teeth"),
                       fmt::format("turntable_procedure.shifts_teeth has {}", shift),
                       fmt::format("shifts from 0 to {}", teeth - 1));
  }
  const std::vector<std::string>& phases = procedure.phases;
  const bool verifies = std::find(phases.begin(), phases.end(), "verification") != phases.end();
  if (verifies && procedure.verification_positions > teeth - procedure.positions)
    throw InputError(Place(text, "turntable_procedure.verification_positions"),
                     fmt::format("{} check positions", procedure.verification_positions),
                     fmt::format("at most {}: the teeth that are no position", teeth - procedure.positions));
}

void CheckSetUps(const ScenarioText& text, const TurntableProcedureSettings& procedure) {
  const auto set_ups = static_cast<std::size_t>(procedure.SetUps());
  const auto check = [&](const std::string& key, std::size_t length) {
    if (length == 1 || length == set_ups) return;
    throw InputError(Place(text, "turntable_procedure." + key),
                     fmt::format("turntable_procedure.{} has {} entries for {} mountings", key, length, set_ups),
                     fmt::format("1 or {}", set_ups));
  };
  check("tilts_arcsec", procedure.tilts_rad.size());
  check("tilt_azimuths_deg", procedure.tilt_azimuths_rad.size());
  check("shifts_teeth", procedure.shifts.size());
  check("eccentricities_um", procedure.eccentricities_m.size());
  check("polygon_offsets_deg", procedure.polygon_offsets_rad.size());
}

/// Beyond it the light meets so different slopes of a face that the first order of what they make is not enough.
void CheckFaces(const ScenarioText& text, const TurntableSettings& own) {
  constexpr double kMost_m = 2000.0 * units::nm;
  if (!own.HasPolygon() || std::abs(own.mirror.flatness_m) <= kMost_m) return;
  throw InputError(Place(text, "mirror.flatness_nm"),
                   fmt::format("faces of a polygon with a sag of {:.6g} nm", own.mirror.flatness_m / units::nm),
                   "at most 2000 nm");
}

}  // namespace

void AddKeys(Keys& keys, Scenario& s) {
  TurntableSettings& own = TurntableOf(s);
  AddTable(keys, "turntable", "in L", own.turntable);
  AddMultitooth(keys, own.multitooth);
  AddTable(keys, "multitooth", "in its rotor frame", own.multitooth_table, false);
  AddPolygon(keys, own.polygon);
  AddEncoder(keys, own.encoder);
  AddMotionOfTheTurntable(keys, own.mechanics);
  AddMirror(keys, own.mirror);
  AddAutocollimator(keys, own.autocollimator);
  AddCollimator(keys, own.collimator);
  AddEnvironment(keys, s.environment);
  AddTurntableProcedure(keys, own.turntable_procedure);
}

void CheckTogether(const ScenarioText& text, const Scenario& s) {
  const TurntableSettings& own = TurntableOf(s);
  CheckFaces(text, own);
  CheckPasses(text, "turntable_procedure.passes", own.turntable_procedure.passes);
  CheckPasses(text, "turntable_procedure.verification_passes", own.turntable_procedure.verification_passes);
  CheckPolygon(text, s);
  if (!own.HasPolygon()) CheckTeeth(text, s);
  CheckSetUps(text, own.turntable_procedure);
}

}  // namespace twinbench::benches::turntable
