#include "twin/benches/circular_motion/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/circular_motion/format.h"
#include "twin/core/errors.h"
#include "twin/core/scenario_together.h"
#include "twin/core/schema_table.h"

namespace twinbench::benches::circular {
namespace {

using namespace schema;

constexpr Unit kUm_m{"um_m", units::um}, kUm_m_K{"um_m_K", units::um}, kUm_K{"um_K", units::um};
constexpr Unit kMm_min{"mm_min", units::mm / 60.0}, kPerMm2{"per_mm2", 1.0 / (units::mm * units::mm)};

/// One key an axis: `name`_x and `name`_y.
void AddPair(Table& t, const std::string& name, const Unit& unit, const Bounds& bounds, AxisPair& pair,
             const std::string& meaning) {
  t.Add(name + "_x", unit, bounds, pair.data(), meaning);
  t.Add(name + "_y", unit, bounds, &pair[1], meaning);
}

void AddErrors(Table& t, CircularMachineSettings& s) {
  AddPair(t, "scale", kUm_m, Within(10000), s.scale, "positioning error in proportion to the way");
  t.Add("squareness", kArcsec, Within(3600), &s.squareness_rad, "the angle from +X to +Y less 90 deg");
  AddPair(t, "straightness", kUm, Within(1000), s.bow_m, "times P2(other axis / span)");
  AddPair(t, "straightness3", kUm, Within(1000), s.s_shape_m, "times P3(other axis / span)");
  AddPair(t, "backlash", kUm, Within(1000), s.backlash_m, "full width");
  AddPair(t, "spike", kUm, Within(1000), s.spike_m, "largest excursion behind a reversal");
  AddPair(t, "cyclic", kUm, Within(1000), s.cyclic_m, "once a pitch, amplitude");
  AddPair(t, "cyclic_phase", kDeg, Within(360), s.cyclic_phase_rad, "of its sine");
  AddPair(t, "expansion", kUm_m_K, Within(1000), s.expansion_per_K, "of the scale, from 20 °C on");
  AddPair(t, "drift", kUm_K, Within(1000), s.drift_m_per_K, "of the spindle against the table, from 20 °C on");
}

void AddMachine(Keys& keys, CircularMachineSettings& s) {
  Table t(keys, "machine");
  AddPair(t, "lag", kSecond, Within(1), s.lag_s, "of the servo; of bodies it follows from [drives]");
  t.Text("lag_kind", &s.lag_kind, {"first_order", "fixed_delay"}, "an axis answers 1 / (1 + lag s), or comes so much later");
  t.Add("span", kMm, Between(1, 10000), &s.span_m, "half the travel over which straightness is stated");
  t.Add("cyclic_pitch", kMm, Positive(1000), &s.cyclic_pitch_m, "of the screw or scale");
  t.Add("spike_time", kSecond, Positive(100), &s.spike_time_s, "from a reversal to the largest excursion");
  t.Add("noise", kUm, UpTo(100), &s.noise_m, "repeatability, an axis and reading, standard deviation");
  AddErrors(t, s);
}

void AddBodies(Keys& keys, CircularMechanicsSettings& s) {
  Table t(keys, "mechanics");
  t.Text("fidelity", &s.fidelity, {"kinematic", "linear", "bullet"},
         "how the axes move: in closed form, or as bodies with [drives]");
}

void AddScrew(Table& t, FeedDrivesSettings& s) {
  AddPair(t, "mass", {"kg"}, Positive(1e5), s.mass_kg, "of the slide and what it carries");
  AddPair(t, "screw_inertia", {"kg_m2"}, Positive(100), s.screw_inertia_kg_m2, "of screw and motor");
  AddPair(t, "lead", kMm, Positive(1000), s.lead_m, "of the screw");
  AddPair(t, "stiffness", {"N_um", 1.0 / units::um}, Positive(1e5), s.stiffness_N_m,
          "along the axis, of screw, nut and bearings");
  AddPair(t, "torsion", {"Nm_rad"}, Positive(1e7), s.torsion_Nm_rad, "stiffness of screw and coupling");
  t.Add("damping_ratio", kPure, UpTo(1), &s.damping_ratio, "of the slide swinging against the screw");
  AddPair(t, "play", kUm, UpTo(1000), s.play_m, "between nut and slide, full width");
}

void AddGuideway(Table& t, FeedDrivesSettings& s) {
  AddPair(t, "friction", {"N"}, UpTo(1e5), s.friction_N, "of the guideway, Coulomb level");
  AddPair(t, "viscous", {"N_s_m"}, UpTo(1e6), s.viscous_N_s_m, "friction by speed");
  t.Add("static_ratio", kPure, {1.0, 10.0}, &s.static_ratio, "breakaway force over Coulomb level");
  t.Add("stribeck", {"mm_s", units::mm}, Positive(1000), &s.stribeck_m_s,
        "speed by which the breakaway force has gone");
  t.Add("presliding", kUm, Positive(100), &s.presliding_m, "way by which the guideway gives before it slips");
}

void AddServo(Table& t, FeedDrivesSettings& s) {
  constexpr Unit kPerSecond{"per_s"};
  AddPair(t, "position_gain", kPerSecond, Positive(1000), s.position_gain_1_s, "Kv of the position controller");
  AddPair(t, "velocity_gain", kPerSecond, Positive(10000), s.velocity_gain_1_s, "band of the speed controller");
  AddPair(t, "integral_time", kSecond, Positive(10), s.integral_time_s, "of the speed controller");
  AddPair(t, "feed_forward", kPure, UpTo(1), s.feed_forward,
          "share of the commanded speed that is fed forward to the speed controller; lag = (1 - share) / Kv");
  t.Text("encoder", &s.encoder, {"motor", "slide"}, "where the position controller reads");
  t.Add("ramp", kSecond, {0.01, 100.0}, &s.ramp_s, "in which the path's speed comes and goes between measuring positions");
  t.Add("servo_period", kMicrosecond, {10.0, 10000.0}, &s.servo_period_s, "of the controllers");
  t.Add("step", kMicrosecond, {1.0, 10000.0}, &s.step_s, "longest, of the bodies within a servo period");
}

void AddDrives(Keys& keys, FeedDrivesSettings& s) {
  Table t(keys, "drives");
  AddScrew(t, s);
  AddGuideway(t, s);
  AddServo(t, s);
}

void AddBar(Keys& keys, BarSettings& s) {
  Table t(keys, "bar");
  t.Add("noise", kUm, UpTo(100), &s.noise_m, "of one reading, standard deviation");
  t.Add("resolution", kUm, UpTo(100), &s.resolution_m, "least step of the reading; 0: none");
  AddPair(t, "offset", kUm, Within(10000), s.offset_m, "commanded centre as seen from ball 1");
  t.Add("height", kMm, Within(100), &s.height_m, "ball 2 above ball 1");
  t.Add("length_error", kUm, Within(10000), &s.length_error_m, "longer than the radius where it shows zero");
  t.Add("gain_error", kPure, Within(0.5), &s.gain_error, "of the transducer");
  t.Add("cubic", kPerMm2, Within(1000), &s.cubic_per_m2, "of the transducer");
  t.Add("ball2", kUm, Within(100), s.ball_m.data(), "form of ball 1, twice per turn");
  t.Add("ball2_azimuth", kDeg, Within(360), s.ball_azimuth_rad.data(), "of its largest radius");
  t.Add("ball3", kUm, Within(100), &s.ball_m[1], "form of ball 1, three times per turn");
  t.Add("ball3_azimuth", kDeg, Within(360), &s.ball_azimuth_rad[1], "of its largest radius");
  t.Add("expansion", kUm_m_K, Within(1000), &s.expansion_per_K, "of the bar, from 20 °C on");
  t.Add("latency", kSecond, Within(1), &s.latency_s, "the reading is this old");
}

void AddEncoder(Keys& keys, BarEncoderSettings& s) {
  Table t(keys, "encoder");
  t.Add("noise", kArcsec, UpTo(3600), &s.noise_rad, "of one reading, standard deviation");
  t.Add("lines", kPure, {1, 10000000}, &s.lines, "per turn");
  t.Add("interpolation", kPure, {1, 1000000}, &s.interpolation, "counts a line");
  t.Add("zero", kDeg, Within(360), &s.zero_rad, "shown where the bar points to +X");
  t.Add("tilt_x", kMrad, Within(100), s.tilt_rad.data(), "of its axis, about X");
  t.Add("tilt_y", kMrad, Within(100), &s.tilt_rad[1], "of its axis, about Y");
  t.Add("eccentricity", kArcsec, Within(3600), &s.eccentricity_rad, "amplitude, once per turn");
  t.Add("eccentricity_azimuth", kDeg, Within(360), &s.eccentricity_azimuth_rad,
        "where its sine rises through zero");
  t.Add("ellipticity", kArcsec, Within(3600), &s.ellipticity_rad, "amplitude, twice per turn");
  t.Add("ellipticity_azimuth", kDeg, Within(360), &s.ellipticity_azimuth_rad, "where its sine rises through zero");
  t.Add("latency", kSecond, Within(1), &s.latency_s, "the reading is this old");
}

void AddGrid(Keys& keys, GridSettings& s) {
  Table t(keys, "grid");
  t.Add("noise", kUm, UpTo(100), &s.noise_m, "of one axis and reading, standard deviation");
  t.Add("period", kUm, Positive(1000), &s.period_m, "of its signals");
  t.Add("rotation", kArcsec, Within(36000), &s.rotation_rad, "of the plate against the machine");
  AddPair(t, "scale", kUm_m, Within(10000), s.scale, "shows too much in proportion");
  t.Add("shear", kArcsec, Within(3600), &s.shear_rad, "of its axes");
  AddPair(t, "offset", kUm, Within(1e6), s.offset_m, "shown at the commanded centre");
  t.Add("sde", kNm, Within(10000), &s.sde_m, "subdivisional error, amplitude");
}

void AddMounting(Keys& keys, CircularMountingSettings& s) {
  Table t(keys, "mounting");
  t.Add("offset", kUm, UpTo(10000), &s.offset_m, "half width of what every mounting draws: centre, along X and Y");
  t.Add("zero", kDeg, UpTo(180), &s.zero_rad, "half width: zero of the encoder");
  t.Add("length", kUm, UpTo(10000), &s.length_m, "half width: length of the bar");
  t.Add("grid_rotation", kArcsec, UpTo(36000), &s.grid_rotation_rad, "half width: rotation of the grid plate");
}

void AddSetup(Table& t, CircularSetup& s) {
  t.Text("instrument", &s.instrument, {"bar", "radial_bar", "grid", "drive"},
         "what measures: a bar on an encoder, a bar alone, a grid plate, the controller's own scales");
  t.Add("radius", kMm, Positive(10000), &s.radius_m, "of the commanded circle");
}

void AddProcedure(Keys& keys, CircularProcedureSettings& s) {
  Table t(keys, "circular_procedure");
  t.Records("setups", s.setups, AddSetup, "what is mounted, one after the other");
  t.Add("feeds", kMm_min, Between(1e-3, 100000), &s.feeds_m_s, "of the sweeps, each in all directions");
  t.Add("points", kPure, {3, 100000}, &s.points, "readings a sweep, evenly spaced");
  t.Add("stops", kPure, UpTo(100000), &s.stops, "per turn, one reading each, after the sweeps; 0: none");
  t.Add("dwell", kSecond, UpTo(3600), &s.dwell_s, "at a measuring position until it is read");
  t.Add("rapid", kMm_min, Between(1e-3, 1e6), &s.rapid_m_s, "from one measuring position to the next");
  t.Add("directions", kPure, {-1, 1}, &s.directions, "1: counter-clockwise from above, -1: clockwise");
  t.Add("start", kDeg, Within(360), &s.start_rad, "where every pass begins");
  t.Add("remount", kSecond, UpTo(1e7), &s.remount_s, "time that a mounting takes");
}

/// What bodies do by themselves must not be stated a second time in closed form.
void CheckNotTwice(const ScenarioText& text, const std::string& key, double value, double allowed,
                   const std::string& instead) {
  if (value == 0.0 || value == allowed) return;
  throw InputError(Place(text, "machine." + key, "mechanics.fidelity"),
                   fmt::format("machine.{} is stated, and mechanics.fidelity asks for bodies", key),
                   fmt::format("no such key: with bodies it follows from {}", instead));
}

void CheckBodies(const ScenarioText& text, const CircularSettings& s) {
  const CircularMachineSettings usual;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string axis = k == 0 ? "x" : "y";
    CheckNotTwice(text, "lag_" + axis + "_s", s.machine.lag_s[k], usual.lag_s[k],
                  "drives.position_gain and feed_forward");
    CheckNotTwice(text, "backlash_" + axis + "_um", s.machine.backlash_m[k], 0.0, "drives.play and friction");
    CheckNotTwice(text, "spike_" + axis + "_um", s.machine.spike_m[k], 0.0, "drives.friction");
    if (s.drives.play_m[k] == 0.0) continue;
    const std::string place = Place(text, "drives.play_" + axis + "_um");
    if (s.drives.friction_N[k] == 0.0)
      throw InputError(place, fmt::format("drives.play_{}_um has no drives.friction_{}_N beside it", axis, axis),
                       "friction above 0: without it the slide floats in its play");
    if (s.mechanics.fidelity == "linear")
      throw InputError(place, fmt::format("drives.play_{}_um in the fidelity \"linear\", which has no play", axis),
                       "mechanics.fidelity = \"bullet\"");
  }
}

/// Far beyond the span the third Legendre polynomial is thousands of its size: no reading is as fine as what it would take.
void CheckSpan(const ScenarioText& text, const CircularSettings& s) {
  constexpr double kMostSpans = 20.0;
  for (const CircularSetup& setup : s.procedure.setups) {
    if (!(setup.radius_m > kMostSpans * s.machine.span_m)) continue;
    throw InputError(Place(text, "machine.span_mm", "circular_procedure.setups"),
                     fmt::format("a circle of {:g} mm has {:.3g} times the radius of machine.span_mm, {:g}", setup.radius_m / units::mm,
                                 setup.radius_m / s.machine.span_m, s.machine.span_m / units::mm),
                     "half the travel over which straightness is stated: some radius of the circles");
  }
}

}  // namespace

void AddKeys(Keys& keys, Scenario& s) {
  CircularSettings& own = CircularOf(s);
  AddMachine(keys, own.machine);
  AddBodies(keys, own.mechanics);
  AddDrives(keys, own.drives);
  AddBar(keys, own.bar);
  AddEncoder(keys, own.encoder);
  AddGrid(keys, own.grid);
  AddMounting(keys, own.mounting);
  AddProcedure(keys, own.procedure);
  AddEnvironment(keys, s.environment);
}

void CheckTogether(const ScenarioText& text, const Scenario& s) {
  const CircularSettings& own = CircularOf(s);
  CheckPasses(text, "circular_procedure.directions", own.procedure.directions);
  CheckSpan(text, own);
  if (own.mechanics.HasBodies()) CheckBodies(text, own);
}

}  // namespace twinbench::benches::circular

namespace twinbench {

StatedNoise StatedNoiseOf(const CircularSettings& s, bool is_bar, double radius_m) {
  constexpr double kLeast_m = 1.0 * units::nm;  // no circle is known better, whatever noise is left out
  const auto with_machine = [&](double noise_m) { return std::max(kLeast_m, std::hypot(noise_m, s.machine.noise_m)); };
  if (!is_bar) return {with_machine(s.grid.noise_m), with_machine(s.grid.noise_m)};
  const double quantum = 1.0 / std::sqrt(12.0), step_rad = units::turn / s.encoder.lines / s.encoder.interpolation;
  return {with_machine(std::hypot(s.bar.noise_m, quantum * s.bar.resolution_m)),
          with_machine(radius_m * std::hypot(s.encoder.noise_rad, quantum * step_rad)),
          quantum * s.bar.resolution_m, radius_m * quantum * step_rad};
}

}  // namespace twinbench
