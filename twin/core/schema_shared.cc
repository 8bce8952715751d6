#include "twin/core/schema_table.h"

/// Keys that several benches have.
namespace twinbench::schema {
namespace {

/// Lengths up to those of a table: beyond them it is a wheel; tilts up to those that the benches' instruments can read.
void AddComponents(Keys& keys, const std::string& table, std::array<double, kComponents>& values,
                   const std::string& meaning, double most_arcsec, double most_tilt_arcsec) {
  Table t(keys, table);
  for (std::size_t i = 0; i < kComponents; ++i) {
    const auto component = static_cast<Component>(i);
    const double most = component == Component::kEz ? most_arcsec : most_tilt_arcsec;
    t.Add(kComponentNames[i], IsAngle(component) ? kArcsec : kUm, UpTo(IsAngle(component) ? most : 500.0), &values[i], meaning);
  }
}

void AddMotion(Table& t, TableSettings& s) {
  t.Add("half_frequency_order", kPure, {0.3, 0.7}, &s.half_frequency_order, "of the bearing, periods per turn");
  t.Add("half_frequency_tilt", kArcsec, UpTo(300), &s.half_frequency_tilt_rad, "amplitude");
  t.Add("half_frequency_radial", kUm, UpTo(100), &s.half_frequency_radial_m, "amplitude");
  t.Add("backlash", kArcsec, UpTo(36000), &s.backlash_rad, "full width, of the servo's encoder against the rotor");
  t.Add("speed", {"deg_s", units::deg}, Between(1e-4, 3600), &s.speed_rad_s, "of long moves");
  t.Add("move_time", kSecond, Positive(3600), &s.move_time_s, "of one step");
  t.Add("settle", kSecond, UpTo(3600), &s.settle_s, "in-position window after the profile");
}

}  // namespace

void AddTable(Keys& keys, const std::string& table, const std::string& frame, TableSettings& s, bool is_driven) {
  Table t(keys, table);
  t.Add("harmonics", kPure, {}, &s.harmonics,
        "systematic errors " + frame + ", amplitude * cos(order * angle + phase)");
  t.Text("errors_file", &s.errors_file, {}, "CSV of the errors " + frame + ", from the scenario's folder");
  AddMotion(t, s);
  if (is_driven)
    t.Text("compensation_file", &s.compensation_file, {},
           "CSV of position_deg, correction_arcsec: added to the angles that the table is commanded to");
  AddComponents(keys, table + ".random", s.random_rms, "rms of random smooth errors", 3600.0, 300.0);
  Table random(keys, table + ".random");
  random.Add("orders", kPure, {1, 1000}, &s.random_orders, "they have harmonics 1..orders, falling as 1/order");
  AddComponents(keys, table + ".seating", s.seating_sd, "scatter of the pose at every mounting", 300.0, 300.0);
  AddComponents(keys, table + ".repeatability", s.repeatability_sd,
                "scatter of the pose at every measuring position", 600.0, 600.0);
  Table(keys, table)
      .Add("errors", kPure, {}, &s.errors, "the content of errors_file: position_deg, ex_arcsec, ...");
  if (is_driven)
    Table(keys, table)
        .Add("compensation", kPure, {}, &s.compensation,
             "the content of compensation_file: position_deg, correction_arcsec");
}

void AddEnvironment(Keys& keys, EnvironmentSettings& s) {
  Table t(keys, "environment");
  t.Add("temperature", kCelsius, {-50, 100}, &s.temperature_degC, "at the start");
  t.Add("reference", kCelsius, {-50, 100}, &s.reference_degC, "at which wavelength and lengths are nominal");
  t.Add("drift", {"K_h"}, Within(100), &s.drift_K_h, "of the temperature [K/h]");
  t.Add("swing", kMillikelvin, UpTo(50000), &s.swing_K, "amplitude of a periodic swing");
  t.Add("swing_period", kSecond, Positive(1e7), &s.swing_period_s, "of the swing");
  t.Add("random_walk", {"K_sqrt_h"}, UpTo(50), &s.random_walk_K_sqrt_h, "standard deviation after an hour");
  t.File("temperature_file", s.temperature_file, "CSV of time_s, temperature_degC");
  t.Add("sensor_noise", kMillikelvin, UpTo(10000), &s.sensor_noise_K, "of the thermometer, standard deviation");
}

void AddAutocollimator(Keys& keys, AutocollimatorSettings& s) {
  Table t(keys, "autocollimator");
  t.Add("noise", kArcsec, UpTo(100), &s.noise_rad, "of one reading, standard deviation");
  t.Add("range", kArcsec, Positive(36000), &s.range_rad, "± this angle");
  t.Add("gain_error", kPure, Within(0.5), &s.gain_error, "of both axes");
}

}  // namespace twinbench::schema
