#include "twin/benches/hob_transmission/settings.h"

#include <fmt/format.h>

#include "twin/benches/hob_transmission/format.h"
#include "twin/core/errors.h"
#include "twin/core/scenario_together.h"
#include "twin/core/schema_table.h"

namespace twinbench::benches::hob {
namespace {

using namespace schema;

constexpr int kFewestStops = 8;
constexpr double kMostWindUp_rad = 10.0 * units::deg;

void AddTransmission(Keys& keys, TransmissionSettings& s) {
  Table t(keys, "transmission");
  t.Add("hob_starts", kPure, {1, 1000}, &s.hob_starts, "of the hob");
  t.Add("gear_teeth", kPure, {1, 100000}, &s.gear_teeth, "that the hob would cut: the gearbox's ratio");
  t.Add("worm_wheel_teeth", kPure, {0, 100000}, &s.worm_wheel_teeth, "of the table's worm wheel; 0: no worm, or one that nobody knows");
  t.Add("worm_starts", kPure, {1, 1000}, &s.worm_starts, "of the worm");
  t.Add("harmonics", kPure, {}, &s.harmonics, "of the transmission error: amplitude * cos(order * table + phase)");
  t.Add("free_orders", kPure, UpTo(1000), &s.free_orders, "an evaluation takes the orders up to this as unknown");
  t.Add("servo", kHz, Positive(500), &s.servo_Hz, "bandwidth of the table's drive");
  t.Add("feed_forward", kPure, UpTo(1), &s.feed_forward, "of the speed; 1: no lag at constant speed");
  t.Add("table_inertia", {"kg_m2"}, Positive(1e6), &s.table_inertia_kg_m2, "of the table with its load");
  t.Add("stiffness", {"Nm_mrad", 1e3}, Positive(1e9), &s.stiffness_Nm_rad, "torsion between worm wheel and table");
  t.Add("damping_ratio", kPure, UpTo(2), &s.damping_ratio, "of that torsion");
  t.Add("friction", {"Nm"}, UpTo(1e4), &s.friction_Nm, "on the table: winds the torsion up, by direction");
  t.Add("backlash", kArcsec, UpTo(1000), &s.backlash_rad, "of the worm, full width at the table");
  t.Text("compensation_file", &s.compensation_file, {},
         "CSV of position_deg, correction_arcsec: added by the gearbox to the table's angle that it commands");
  t.Add("compensation", kPure, {}, &s.compensation,
        "the content of compensation_file: position_deg, correction_arcsec");
}

void AddRing(Keys& keys, const std::string& table, RingEncoderSettings& s) {
  Table t(keys, table);
  t.Add("lines", kPure, {1, 10000000}, &s.lines, "per turn");
  t.Add("radius", kMm, Between(1, 5000), &s.radius_m, "of the ring");
  t.Add("eccentricity", kUm, UpTo(10000), &s.eccentricity_m, "of its middle from the shaft's axis");
  t.Add("eccentricity_azimuth", kDeg, Within(360), &s.eccentricity_azimuth_rad, "on the ring");
  t.Add("tilt", kArcsec, Within(36000), &s.tilt_rad, "of the ring against the shaft");
  t.Add("tilt_azimuth", kDeg, Within(360), &s.tilt_azimuth_rad, "on the ring: of its tilt axis");
  t.Add("head_height", kMm, Within(1000), &s.head_height_m, "of the head above the ring's middle plane");
  t.Add("ellipticity", kUm, UpTo(10000), &s.ellipticity_m, "half the difference of largest and smallest radius");
  t.Add("ellipticity_azimuth", kDeg, Within(360), &s.ellipticity_azimuth_rad, "on the ring: of the largest radius");
  t.Add("graduation", kPure, {}, &s.graduation,
        "error of the lines: amplitude * cos(order * ring's angle + phase)");
  t.Add("interpolation", kPure, {1, 1000000}, &s.interpolation, "steps a line");
  t.Add("noise", kArcsec, UpTo(3600), &s.noise_rad, "of one reading, white, standard deviation");
}

void AddInterferometer(Keys& keys, InterferometerSettings& s) {
  Table t(keys, "interferometer");
  t.Flag("used", s.used, "the transmission error is compared with it");
  t.Add("noise", kArcsec, UpTo(3600), &s.noise_rad, "of one reading, standard deviation");
  t.Add("misalignment", kMrad, Within(200), &s.misalignment_rad,
        "of the beam against the reflector's way: it sees cos of the deviation");
  t.Add("arm", kMm, Between(1, 1000), &s.arm_m, "between the two paths of its angle optics");
  t.Add("arm_error", kUm, Within(1000), &s.arm_error_m, "by which the real arm is longer");
  t.Add("dead_path", kMm, Within(10000), &s.dead_path_m, "by which one path is longer at zero");
  t.Add("index_drift", {"ppm_h", 1e-6}, Within(100), &s.index_drift_per_h, "of the air's refractive index");
  t.Add("calibrator", kPure, {}, &s.calibrator,
        "error of the calibrator on the table: amplitude * cos(order * table + phase)");
  t.Add("u_calibrator", kArcsec, UpTo(3600), &s.u_calibrator_rad,
        "standard uncertainty of that error: of the cosine and of the sine of any order");
  t.Add(
      "stops", kPure, {0, 100000}, &s.stops,
      "per turn at which it is read at rest, in the first mounting behind its passes, each way; 0: with every sample");
}

void AddHobProcedure(Keys& keys, HobProcedureSettings& s) {
  Table t(keys, "hob_procedure");
  t.Add("heads", kDeg, Within(360), &s.heads_rad, "where the mark passes the table's reading head, one per mounting");
  t.Text("encoder_zero", &s.encoder_zero, {"table_origin", "reference_mark"},
         "where the table's encoder counts from");
  t.Add("hob_speeds", {"rev_min", 2.0 * units::kPi / 60.0}, Between(0.01, 100000), &s.hob_speeds_rad_s,
        "one after the other");
  t.Add("passes", kPure, {-1, 1}, &s.passes, "directions of the table, 1 or -1; at each speed");
  t.Add("turns", kPure, {1, 1000}, &s.turns, "of the table, a pass");
  t.Add("samples_per_turn", kPure, {4, 1000000}, &s.samples_per_turn, "of the table; divides table_encoder.lines");
  t.Add("ramp", kSecond, {0.01, 3600.0}, &s.ramp_s, "to reach the speed and to stop");
  t.Add("rest", kSecond, UpTo(86400), &s.rest_s, "behind every pass");
  t.Add("remount", kSecond, UpTo(1e7), &s.remount_s, "time that a mounting takes");
  t.Add("fifo_samples", kPure, {1, kHuge}, &s.fifo_samples, "that the counter card holds");
  t.Add("poll", kSecond, Between(1e-3, 3600), &s.poll_s, "the computer empties the FIFO this often");
}

void AddMotionOfTheChain(Keys& keys, MechanicsSettings& s) {
  Table t(keys, "mechanics");
  t.Text("fidelity", &s.fidelity, {"kinematic", "bullet"}, "how the bodies move");
}

void CheckAngles(const ScenarioText& text, const std::string& key, const std::vector<HarmonicSettings>& harmonics) {
  for (const HarmonicSettings& harmonic : harmonics) {
    if (harmonic.component != Component::kEz)
      throw InputError(Place(text, key), fmt::format("{} has a harmonic of another component", key), "\"ez\"");
  }
}

}  // namespace

void AddKeys(Keys& keys, Scenario& s) {
  HobSettings& own = HobOf(s);
  AddTransmission(keys, own.transmission);
  AddRing(keys, "table_encoder", own.table_encoder);
  AddRing(keys, "hob_encoder", own.hob_encoder);
  AddInterferometer(keys, own.interferometer);
  AddMotionOfTheChain(keys, own.mechanics);
  AddHobProcedure(keys, own.hob_procedure);
}

void CheckTogether(const ScenarioText& text, const Scenario& s) {
  const HobSettings& own = HobOf(s);
  CheckPasses(text, "hob_procedure.passes", own.hob_procedure.passes);
  CheckAngles(text, "transmission.harmonics", own.transmission.harmonics);
  CheckAngles(text, "table_encoder.graduation", own.table_encoder.graduation);
  CheckAngles(text, "hob_encoder.graduation", own.hob_encoder.graduation);
  CheckAngles(text, "interferometer.calibrator", own.interferometer.calibrator);
  const double wind_up_rad = own.transmission.friction_Nm / own.transmission.stiffness_Nm_rad;
  if (wind_up_rad > kMostWindUp_rad)
    throw InputError(Place(text, "transmission.stiffness_Nm_mrad"),
                     fmt::format("the friction of {:.4g} Nm winds the table up by {:.3g} deg", own.transmission.friction_Nm, wind_up_rad / units::deg),
                     fmt::format("at most {:.0f} deg", kMostWindUp_rad / units::deg));
  if (own.table_encoder.lines % own.hob_procedure.samples_per_turn != 0)
    throw InputError(Place(text, "hob_procedure.samples_per_turn"),
                     fmt::format("{} samples per turn", own.hob_procedure.samples_per_turn),
                     fmt::format("a divisor of the {} lines of the table's encoder", own.table_encoder.lines));
  const int stops = own.interferometer.stops;
  if (stops != 0 && stops < kFewestStops)
    throw InputError(Place(text, "interferometer.stops"), fmt::format("{} measuring positions per turn", stops),
                     fmt::format("0 or at least {}: so many tell the orders 1 and 2", kFewestStops));
  for (const double speed_rad_s : own.hob_procedure.hob_speeds_rad_s) {
    if (speed_rad_s <= 0.0)
      throw InputError(Place(text, "hob_procedure.hob_speeds_rev_min"), "a speed is 0", "speeds above 0");
  }
}

}  // namespace twinbench::benches::hob
