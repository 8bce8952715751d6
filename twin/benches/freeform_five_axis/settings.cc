#include "twin/benches/freeform_five_axis/settings.h"

#include "twin/benches/freeform_five_axis/format.h"
#include "twin/core/schema_table.h"

namespace twinbench::benches::freeform {
namespace {

using namespace schema;

void AddMachine(Keys& keys, MachineSettings& s) {
  Table t(keys, "machine");
  t.Add("pivot", kMm, UpTo(10000), &s.pivot_m, "from the axes A and B to the tip of the probe");
  for (std::size_t k = 0; k < kSquarenesses; ++k)
    t.Add(kSquarenessNames[k], kArcsec, Within(36000), &s.squareness_rad[k], "squareness");
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    const Unit unit = IsRotaryAxis(static_cast<int>(axis)) ? kDeg : kMm;
    const std::string name = kAxisNames[axis];
    t.Add(name + "_centre", unit, Within(10000), &s.centre[axis], "where t of its cubics is 0");
    t.Add(name + "_half", unit, Positive(10000), &s.half[axis], "from there to t = 1");
  }
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    Table errors(keys, std::string("machine.") + kAxisNames[axis]);
    for (std::size_t k = 0; k < kBodyErrors; ++k)
      errors.Add(kBodyErrorNames[k], IsRotation(static_cast<int>(k)) ? kArcsec : kUm, Within(1e5),
                 List(s.errors[axis][k]), "error of the moved body: c0, c1, c2, c3 of a cubic in t");
  }
  Table random(keys, "machine.random");
  random.Add("translation", kUm, UpTo(10000), &s.random_translation_m,
             "standard deviation of what c0 and c1 have beyond that; c2 0.7 of it, c3 0.5");
  random.Add("rotation", kArcsec, UpTo(3600), &s.random_rotation_rad, "likewise");
  random.Add("squareness", kArcsec, UpTo(3600), &s.random_squareness_rad, "likewise of the squareness errors");
}

void AddArtefact(Keys& keys, ArtefactSettings& s) {
  Table t(keys, "artefact");
  t.Add("vertex_radius", kMm, Positive(10000), List(s.vertex_radius_m), "of its cells, in turn like a chessboard");
  t.Add("pitch", kMm, Positive(1000), &s.pitch_m, "of the cells");
  t.Add("cells", kPure, {0, 100}, &s.cells, "from the middle to the last one, in x and y");
  t.File("form_error", s.form_error,
         "OpenEXR of heights [um] over the array, +x to the right, +y up, beside its form");
  t.Add("mounting", kUm, UpTo(10000), &s.mounting_m, "standard deviation of where a mounting really stands");
  t.Add("mounting", kArcsec, UpTo(3600), &s.mounting_rad, "likewise of how it is turned");
}

void AddProbe(Keys& keys, QuadrantSettings& qpd, CameraSettings& ccd) {
  Table q(keys, "qpd"), c(keys, "ccd");
  q.Add("lens", kMm, Positive(10000), &qpd.lens_m, "focal length");
  q.Add("spot_radius", kMm, Positive(100), &qpd.spot_radius_m, "1/e^2, of a Gaussian spot");
  q.Add("gap", kMm, UpTo(10), &qpd.gap_m, "between quadrants");
  q.Add("sum", kVolt, Positive(1000), &qpd.sum_V, "of all light");
  q.Add("noise", kMillivolt, UpTo(1e5), &qpd.noise_V, "of one reading, standard deviation");
  c.Add("object", kMm, Positive(10000), &ccd.object_m, "from the tip to the lens");
  c.Add("image", kMm, Positive(10000), &ccd.image_m, "from the lens to the detector");
  c.Add("alpha", kDeg, {1, 89}, &ccd.alpha_rad, "between the beam and the lens' axis");
  c.Add("pixel", kUm, Positive(1000), &ccd.pixel_m, "pitch");
  c.Add("centre", {"px"}, Within(1e6), &ccd.centre_px, "where the tip is seen");
  c.Add("noise", {"px"}, UpTo(1000), &ccd.noise_px, "of one reading, standard deviation");
}

void AddOptics(Keys& keys, ProbeOpticsSettings& s) {
  Table t(keys, "optics");
  const Bounds share{0.0, 0.5};
  t.Text("fidelity", &s.fidelity, {"traced", "closed"},
         "how the probe's light is found: by Embree, or by a formula");
  t.Text("spot", &s.spot, {"stated", "beam"}, "as qpd.spot_radius says, or as the beam's rays make it");
  t.Add("beam_radius", kMm, Positive(1), &s.beam_radius_m, "1/e^2, of the beam's waist at the tip");
  t.Add("wavelength", kNm, {100, 20000}, &s.wavelength_m, "of the laser");
  t.Text("splitter", &s.splitter, {"grid", "stack"}, "of wires, or of layers, through which rays askew leak");
  t.Add("splitter_p_reflected", kPure, share, &s.splitter_p_reflected, "share of what should go through it");
  t.Add("splitter_s_transmitted", kPure, share, &s.splitter_s_transmitted, "share of what it should reflect");
  t.Add("plate_reflected", kPure, share, &s.plate_reflected, "share that each face of the wave plate reflects");
  t.Add("plate_retardance", kDeg, Within(90), &s.plate_retardance_rad, "beyond a quarter wave");
  t.Add("plate_azimuth", kDeg, Within(45), &s.plate_azimuth_rad, "of its axis, beyond 45 deg");
  t.Add("plate_tilt_x", kMrad, Within(100), &s.plate_tilt_x_rad, "about the tool's x");
  t.Add("plate_tilt_y", kMrad, Within(100), &s.plate_tilt_y_rad, "about the tool's y");
}

void AddDisplacement(Keys& keys, DisplacementSettings& s) {
  Table t(keys, "displacement");
  t.Text("topology", &s.topology, {"auto", "table_table", "table_head", "head_head"},
         "where the rotary axes are; auto: by the commanded positions");
  t.Text("axes", &s.axes, {},
         "rotary axes from the bed on, those of the table, then those of the head: \"AC\"; \"A-C\": C against the right-hand rule; left out: by the commanded positions");
  t.Text("positions", &s.positions, {"auto", "machine", "workpiece"},
         "what x, y, z are: places of the slides, or of the ball on the workpiece; auto: of the workpiece where they stand still");
  t.Text("seen_from", &s.seen_from, {"auto", "tool", "workpiece"},
         "the displacement is that of the workpiece seen from the tool, or the other way round; auto: from the tool where only tables turn");
  t.Text("frame", &s.frame, {"machine", "table", "tool"}, "along whose axes dx, dy and dz are");
  t.Add("tool", kMm, UpTo(10000), &s.tool_m, "from the last axis of the head to the tool's point, where x, y, z are of the workpiece");
  t.Add("highest_order", kPure, {0, 20}, &s.highest_order, "of component errors per turn of a rotary axis");
  t.Add("noise", kUm, UpTo(1000), &s.noise_m, "of one reading, standard deviation; 0: from what is left over");
}

void AddMount(Table& t, MountSettings& s) {
  t.Add("x", kMm, Within(10000), &s.x_m, "");
  t.Add("y", kMm, Within(10000), &s.y_m, "");
  t.Add("z", kMm, Within(10000), &s.z_m, "");
  t.Add("yaw", kDeg, Within(360), &s.yaw_rad, "");
}

void AddProcedure(Keys& keys, FreeformProcedureSettings& s) {
  Table t(keys, "freeform_procedure");
  t.Text("instrument", &s.instrument, {"probe", "displacement"}, "what reads; displacements at poses are imported, not simulated");
  t.Records("mounts", s.mounts, AddMount, "where the artefact stands, one per mounting");
  t.Add("poses", kPure, {1, 100000}, &s.poses, "per mounting; each is read on the way forth and back");
  t.Add("angle", kDeg, UpTo(45), &s.angle_rad, "A and B go so far to either side");
  t.Add("height", kMm, {0.5, 1000.0}, &s.height_m, "the tip stands off the surface by up to this, to either side");
  t.Add("dither", kUm, UpTo(10000), &s.dither_m, "of X and Y at every pose, uniform to either side");
  t.Add("dither", kDeg, UpTo(10), &s.dither_rad, "likewise of A and B");
  t.Text("path", &s.path, {"joint", "single"}, "all axes together, or one after the other");
  t.Add("interval", kSecond, Positive(600), &s.interval_s, "from reading to reading; longer where the way is");
  t.Add("remount", kSecond, UpTo(1e7), &s.remount_s, "time that a mounting takes");
}

}  // namespace

void AddKeys(Keys& keys, Scenario& s) {
  FreeformSettings& own = FreeformOf(s);
  AddMachine(keys, own.machine);
  AddArtefact(keys, own.artefact);
  AddProbe(keys, own.qpd, own.ccd);
  AddOptics(keys, own.optics);
  AddDisplacement(keys, own.displacement);
  AddProcedure(keys, own.freeform_procedure);
  AddEnvironment(keys, s.environment);
}

}  // namespace twinbench::benches::freeform
