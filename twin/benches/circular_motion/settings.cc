#include "twin/benches/circular_motion/settings.h"

#include "twin/benches/circular_motion/format.h"
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
  AddPair(t, "expansion", kUm_m_K, Within(1000), s.expansion_per_K, "of the scale, from 20 degC on");
  AddPair(t, "drift", kUm_K, Within(1000), s.drift_m_per_K, "of the spindle against the table, from 20 degC on");
}

void AddMachine(Keys& keys, CircularMachineSettings& s) {
  Table t(keys, "machine");
  AddPair(t, "lag", kSecond, Within(1), s.lag_s, "of the servo");
  t.Add("span", kMm, Positive(10000), &s.span_m, "half the travel over which straightness is stated");
  t.Add("cyclic_pitch", kMm, Positive(1000), &s.cyclic_pitch_m, "of the screw or scale");
  t.Add("spike_time", kSecond, Positive(100), &s.spike_time_s, "from a reversal to the largest excursion");
  t.Add("noise", kUm, UpTo(100), &s.noise_m, "repeatability, an axis and reading, standard deviation");
  AddErrors(t, s);
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
  t.Add("ball2", kUm, Within(100), s.ball_m.data(), "form of ball 1, twice a turn");
  t.Add("ball2_azimuth", kDeg, Within(360), s.ball_azimuth_rad.data(), "of its largest radius");
  t.Add("ball3", kUm, Within(100), &s.ball_m[1], "form of ball 1, three times a turn");
  t.Add("ball3_azimuth", kDeg, Within(360), &s.ball_azimuth_rad[1], "of its largest radius");
  t.Add("expansion", kUm_m_K, Within(1000), &s.expansion_per_K, "of the bar, from 20 degC on");
  t.Add("latency", kSecond, Within(1), &s.latency_s, "the reading is this old");
}

void AddEncoder(Keys& keys, BarEncoderSettings& s) {
  Table t(keys, "encoder");
  t.Add("noise", kArcsec, UpTo(3600), &s.noise_rad, "of one reading, standard deviation");
  t.Add("lines", kPure, {1, 10000000}, &s.lines, "a turn");
  t.Add("interpolation", kPure, {1, 1000000}, &s.interpolation, "counts a line");
  t.Add("zero", kDeg, Within(360), &s.zero_rad, "shown where the bar points to +X");
  t.Add("tilt_x", kMrad, Within(100), s.tilt_rad.data(), "of its axis, about X");
  t.Add("tilt_y", kMrad, Within(100), &s.tilt_rad[1], "of its axis, about Y");
  t.Add("eccentricity", kArcsec, Within(3600), &s.eccentricity_rad, "amplitude, once a turn");
  t.Add("eccentricity_azimuth", kDeg, Within(360), &s.eccentricity_azimuth_rad,
        "where its sine rises through zero");
  t.Add("ellipticity", kArcsec, Within(3600), &s.ellipticity_rad, "amplitude, twice a turn");
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
  t.Add("offset", kUm, UpTo(10000), &s.offset_m, "half width of what every set-up draws: centre, along X and Y");
  t.Add("zero", kDeg, UpTo(180), &s.zero_rad, "half width: zero of the encoder");
  t.Add("length", kUm, UpTo(10000), &s.length_m, "half width: length of the bar");
  t.Add("grid_rotation", kArcsec, UpTo(36000), &s.grid_rotation_rad, "half width: rotation of the grid plate");
}

void AddSetup(Table& t, CircularSetup& s) {
  t.Text("instrument", &s.instrument, {"bar", "grid"}, "what measures");
  t.Add("radius", kMm, Positive(10000), &s.radius_m, "of the commanded circle");
}

void AddProcedure(Keys& keys, CircularProcedureSettings& s) {
  Table t(keys, "circular_procedure");
  t.Records("setups", s.setups, AddSetup, "what is mounted, one after the other");
  t.Add("feeds", kMm_min, Positive(100000), &s.feeds_m_s, "of the sweeps, each in all directions");
  t.Add("points", kPure, {3, 100000}, &s.points, "readings a sweep, evenly spaced");
  t.Add("stops", kPure, UpTo(100000), &s.stops, "a turn, one reading each, behind the sweeps; 0: none");
  t.Add("dwell", kSecond, UpTo(3600), &s.dwell_s, "at a stop until it is read");
  t.Add("rapid", kMm_min, Positive(1e6), &s.rapid_m_s, "from stop to stop");
  t.Add("directions", kPure, {-1, 1}, &s.directions, "1: counter-clockwise from above, -1: clockwise");
  t.Add("start", kDeg, Within(360), &s.start_rad, "where every pass begins");
}

}  // namespace

void AddKeys(Keys& keys, Scenario& s) {
  CircularSettings& own = CircularOf(s);
  AddMachine(keys, own.machine);
  AddBar(keys, own.bar);
  AddEncoder(keys, own.encoder);
  AddGrid(keys, own.grid);
  AddMounting(keys, own.mounting);
  AddProcedure(keys, own.procedure);
  AddEnvironment(keys, s.environment);
}

void CheckTogether(const ScenarioText& text, const Scenario& s) {
  CheckPasses(text, "circular_procedure.directions", CircularOf(s).procedure.directions);
}

}  // namespace twinbench::benches::circular
