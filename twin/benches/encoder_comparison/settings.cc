#include "twin/benches/encoder_comparison/settings.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/format.h"
#include "twin/core/errors.h"
#include "twin/core/scenario_text.h"
#include "twin/core/scenario_together.h"
#include "twin/core/schema_table.h"

namespace twinbench::benches::encoder {
namespace {

using namespace schema;

void AddDevice(Keys& keys, DeviceSettings& s) {
  Table t(keys, "device");
  t.Add("noise", kDeg, UpTo(10), &s.noise_rad, "of one reading, white, standard deviation");
  t.Flag("noise_known", s.noise_known, "false: an evaluation estimates it from the readings");
  t.Add("resolution", kDeg, UpTo(10), &s.resolution_rad, "least step of the reading; 0: none");
  t.Add("turn", kMm, UpTo(1e7), &s.turn_m, "linear axis: the way that counts as one turn; 0: the axis turns");
  t.Add("lines_per_turn", kPure, UpTo(10000000), &s.lines, "of its scale; 0: not known");
  t.Add("teeth", kPure, UpTo(100000), &s.teeth, "of a gear between reference and device; 0: none known");
  t.Add("stamp_noise", {"ns", 1e-9}, UpTo(1e6), &s.stamp_noise_s, "coast: of the time at which a line passes");
  t.Add("signal_periods", kPure, {1, 100000}, &s.signal_periods, "of its sine and cosine signals per turn");
  t.Add("signal_zero", kDeg, Within(360), &s.signal_zero_rad, "device angle where the sine rises through zero");
  t.Flag("signal_zero_known", s.signal_zero_known, "false: the phase of signal faults is left free");
  t.Add("graduation", kArcsec, UpTo(36000), &s.graduation_rad, "error of its scale, drawn, root mean square");
  t.Add("graduation_fall", kPure, UpTo(4), &s.graduation_fall, "of the same: order k has a size as k^-fall");
  t.Add("graduation_orders", kPure, {1, 2000}, &s.graduation_orders, "of the same: the highest order");
}

void AddEncoderProcedure(Keys& keys, EncoderProcedureSettings& s) {
  Table t(keys, "encoder_procedure");
  t.Text("kind", &s.kind, {"stops", "sweep", "coast"},
         "readings at rest, in motion, or times of lines while the spindle runs down");
  t.Add("turns", kPure, Positive(1000), &s.turns, "of a pass");
  t.Add("start", kDeg, Within(360000), &s.start_rad, "where the first pass begins");
  t.Add("passes", kPure, {-1, 1}, &s.passes, "directions: 1 or -1; a sweep does them at each speed");
  t.Add("mounting", kDeg, Within(360), &s.mounting_rad, "device angle where the reference shows 0, one per mounting");
  t.Add("remount", kSecond, UpTo(1e7), &s.remount_s, "time that a mounting takes");
  t.Add("heads", kDeg, Within(360), &s.heads_rad, "where heads read the device's ring, all at once");
  t.Add("reference_noise", kArcsec, UpTo(36000), &s.reference_noise_rad,
        "of what the reference shows at one instant, the same for all heads");
  t.Add("stops_per_turn", kPure, {3, 100000}, &s.stops, "stops: evenly spaced");
  t.Add("stop_interval", kSecond, Positive(86400), &s.stop_interval_s, "stops: between readings");
  t.Add("readings_per_stop", kPure, {1, 100000}, &s.readings_per_stop,
        "stops: at each of them; their mean is one reading");
  t.Add("read", kSecond, Positive(3600), &s.read_s, "stops: that each of these takes");
  t.Add("speeds", {"deg_s", units::deg}, Between(1e-4, 36000), &s.speeds_rad_s, "sweep: one after the other; coast: at the start");
  t.Add("ramp", kSecond, Positive(3600), &s.ramp_s, "sweep: to reach the speed and to stop");
  t.Add("rest", kSecond, UpTo(86400), &s.rest_s, "sweep, coast: behind every pass");
  t.Add("interval", kSecond, Positive(3600), &s.interval_s, "sweep: between readings");
  t.Add("stamps_per_turn", kPure, {8, 100000}, &s.stamps, "coast: lines whose times are taken");
}

void AddSpindle(Keys& keys, SpindleSettings& s) {
  const Unit acceleration{"deg_s2", units::deg};
  Table t(keys, "spindle");
  t.Add("friction", acceleration, UpTo(36000), &s.friction_rad_s2, "coast: what it loses at any speed");
  t.Add("viscous", {"per_s"}, UpTo(10), &s.viscous_per_s, "coast: by speed");
  t.Add("drag", {"per_turn", 1.0 / units::turn}, UpTo(10), &s.drag_per_rad, "coast: by the speed's square");
  t.Add("torque", acceleration, UpTo(36000), &s.torque_rad_s2, "coast: of magnets or unbalance, as cos(order angle)");
  t.Add("torque_order", kPure, {1, 2000}, &s.torque_order, "of the same");
  t.Add("ripple", acceleration, UpTo(36000), &s.ripple_rad_s2, "coast: of the friction, as cos(order angle)");
  t.Add("ripple_order", kPure, {1, 2000}, &s.ripple_order, "of the same");
}

/// @throws InputError if a stop is too short for its readings.
void CheckReadingsOfAStop(const ScenarioText& text, const EncoderProcedureSettings& p) {
  if (p.ReadingsAtOnce() == 1 || p.readings_per_stop * p.read_s <= p.stop_interval_s) return;
  throw InputError(text.Where("encoder_procedure.readings_per_stop", text.name() + ":1"),
                   fmt::format("{} readings of {:.4g} s take longer than the {:.4g} s of a measuring position", p.readings_per_stop,
                               p.read_s, p.stop_interval_s),
                   fmt::format("at most {:.0f}, or a longer encoder_procedure.stop_interval_s",
                               std::max(1.0, std::floor(p.stop_interval_s / p.read_s))));
}

/// @throws InputError if the spindle would stand still within a pass, or several heads are read.
void CheckCoast(const ScenarioText& text, const EncoderSettings& own) {
  const EncoderProcedureSettings& p = own.encoder_procedure;
  if (p.kind != "coast") return;
  if (p.heads_rad.size() > 1)
    throw InputError(text.Where("encoder_procedure.heads_deg", text.name() + ":1"), "encoder_procedure.heads_deg has several heads",
                     "one, where the spindle coasts");
  constexpr int kMostOrders = 500;  // CoastOptions::max_order
  const int highest = std::min(kMostOrders, (p.stamps - 1) / 2);
  if (own.device.graduation_rad > 0.0 && own.device.graduation_orders > highest)
    throw InputError(text.Where("device.graduation_orders", text.name() + ":1"),
                     fmt::format("device.graduation_orders is {}, and {} lines per turn show orders up to {} (higher ones look like lower ones)",
                                 own.device.graduation_orders, p.stamps, highest),
                     fmt::format("at most {}, or more encoder_procedure.stamps_per_turn", highest));
  const SpindleSettings& d = own.spindle;
  for (const double speed_rad_s : p.speeds_rad_s) {
    const double loss = d.friction_rad_s2 / speed_rad_s + d.viscous_per_s + d.drag_per_rad * speed_rad_s;
    const double lost_rad_s = loss * p.turns * units::turn;
    if (lost_rad_s > 0.5 * speed_rad_s)
      throw InputError(text.Where("encoder_procedure.speeds_deg_s", text.name() + ":1"),
                       fmt::format("at {:.4g} deg/s the spindle would lose {:.4g} deg/s in {:.4g} turns",
                                   speed_rad_s / units::deg, lost_rad_s / units::deg, p.turns),
                       "no more than half of its speed in a pass");
  }
}

/// @throws InputError if stops, or so slow a sweep, would have more readings than fit into memory.
void CheckReadings(const ScenarioText& text, const EncoderProcedureSettings& p) {
  constexpr double kMostReadings = 2e6;  // of some kilobytes each
  if (p.kind == "coast") return;
  double readings = p.kind == "stops" ? p.turns * p.stops : 0.0;
  for (const double speed_rad_s : p.speeds_rad_s)
    readings += p.kind == "sweep" ? (p.turns * units::turn / speed_rad_s + 2.0 * p.ramp_s + p.rest_s) / p.interval_s : 0.0;
  readings *= static_cast<double>(p.passes.size() * p.mounting_rad.size() * p.heads_rad.size());
  if (readings <= kMostReadings) return;
  throw InputError(text.Where("encoder_procedure.turns", text.name() + ":1"),
                   fmt::format("{} of {:.4g} turns by {} heads in {} passes of {} mountings are {:.3g} readings", p.kind, p.turns,
                               p.heads_rad.size(), p.passes.size(), p.mounting_rad.size(), readings),
                   fmt::format("at most {:.0f}", kMostReadings));
}

}  // namespace

void AddKeys(Keys& keys, Scenario& s) {
  EncoderSettings& own = EncoderOf(s);
  AddDevice(keys, own.device);
  AddEncoderProcedure(keys, own.encoder_procedure);
  AddSpindle(keys, own.spindle);
  AddEnvironment(keys, s.environment);
}

void CheckTogether(const ScenarioText& text, const Scenario& s) {
  const EncoderSettings& own = EncoderOf(s);
  CheckPasses(text, "encoder_procedure.passes", own.encoder_procedure.passes);
  CheckReadingsOfAStop(text, own.encoder_procedure);
  CheckCoast(text, own);
  CheckReadings(text, own.encoder_procedure);
}

}  // namespace twinbench::benches::encoder
