#include "twin/core/scenario_together.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "twin/core/errors.h"
#include "twin/core/reading.h"

namespace twinbench {
namespace {

std::string Place(const ScenarioText& text, const std::string& key) {
  return text.Where(key, text.name() + ":1");
}

void CheckScanList(const ScenarioText& text, const AdcSettings& adc) {
  const std::set<std::string> once(adc.scan_list.begin(), adc.scan_list.end());
  if (once.size() == kChannelNames.size() && adc.scan_list.size() == kChannelNames.size()) return;
  throw InputError(text.Where("adc.scan_list", text.name() + ":1"),
                   fmt::format("adc.scan_list names {} of the {} channels in {} entries", once.size(),
                               kChannelNames.size(), adc.scan_list.size()),
                   "every channel once");
}

void CheckShifts(const ScenarioText& text, const ProcedureSettings& procedure) {
  const std::string where = text.Where("procedure.shifts", text.Where("procedure.positions", text.name() + ":1"));
  const std::vector<int>& shifts = procedure.shifts;
  for (const int shift : shifts) {
    if (shift >= procedure.positions)
      throw InputError(where, fmt::format("procedure.shifts has {}", shift),
                       fmt::format("shifts from 0 to {} (positions - 1)", procedure.positions - 1));
    if (std::count(shifts.begin(), shifts.end(), shift) > 1)
      throw InputError(where, fmt::format("procedure.shifts has {} twice", shift), "every shift once");
  }
}

void CheckPasses(const ScenarioText& text, const std::string& key, const std::vector<int>& passes) {
  if (std::find(passes.begin(), passes.end(), 0) != passes.end())
    throw InputError(text.Where(key, text.name() + ":1"), key + " has 0", "directions 1 or -1");
}

void CheckProfile(const ScenarioText& text, const LaserSettings& laser) {
  if (laser.beam == BeamModel::kProfile && laser.profile_file.empty())
    throw InputError(text.Where("laser.beam", text.name() + ":1"), "laser.beam is \"profile\" without a file",
                     "laser.profile_file = \"beam.exr\"");
}

// --- turntable_autocollimator ---

void CheckTeeth(const ScenarioText& text, const Scenario& s) {
  const int teeth = s.multitooth.teeth;
  const TurntableProcedureSettings& procedure = s.turntable_procedure;
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
                     fmt::format("turntable_procedure.{} has {} entries for {} set-ups", key, length, set_ups),
                     fmt::format("1 or {}", set_ups));
  };
  check("tilts_arcsec", procedure.tilts_rad.size());
  check("tilt_azimuths_deg", procedure.tilt_azimuths_rad.size());
  check("shifts_teeth", procedure.shifts.size());
  check("eccentricities_um", procedure.eccentricities_m.size());
}

// --- hob_transmission ---

void CheckAngles(const ScenarioText& text, const std::string& key, const std::vector<HarmonicSettings>& harmonics) {
  for (const HarmonicSettings& harmonic : harmonics) {
    if (harmonic.component != Component::kEz)
      throw InputError(Place(text, key), fmt::format("{} has a harmonic of another component", key), "\"ez\"");
  }
}

void CheckHob(const ScenarioText& text, const Scenario& s) {
  CheckAngles(text, "transmission.harmonics", s.transmission.harmonics);
  CheckAngles(text, "table_encoder.graduation", s.table_encoder.graduation);
  CheckAngles(text, "hob_encoder.graduation", s.hob_encoder.graduation);
  if (s.table_encoder.lines % s.hob_procedure.samples_per_turn != 0)
    throw InputError(Place(text, "hob_procedure.samples_per_turn"),
                     fmt::format("{} samples a turn", s.hob_procedure.samples_per_turn),
                     fmt::format("a divisor of the {} lines of the table's encoder", s.table_encoder.lines));
  for (const double speed_rad_s : s.hob_procedure.hob_speeds_rad_s) {
    if (speed_rad_s <= 0.0)
      throw InputError(Place(text, "hob_procedure.hob_speeds_rev_min"), "a speed is 0", "speeds above 0");
  }
}

}  // namespace

void CheckTogether(const ScenarioText& text, const Scenario& s) {
  CheckScanList(text, s.adc);
  CheckShifts(text, s.procedure);
  CheckPasses(text, "procedure.passes", s.procedure.passes);
  CheckPasses(text, "encoder_procedure.passes", s.encoder_procedure.passes);
  CheckPasses(text, "turntable_procedure.passes", s.turntable_procedure.passes);
  CheckPasses(text, "turntable_procedure.verification_passes", s.turntable_procedure.verification_passes);
  CheckPasses(text, "hob_procedure.passes", s.hob_procedure.passes);
  CheckProfile(text, s.laser);
  CheckTeeth(text, s);
  CheckSetUps(text, s.turntable_procedure);
  CheckHob(text, s);
}

}  // namespace twinbench
