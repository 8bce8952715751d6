#include "twin/report/controller_tables.h"

#include <fmt/format.h>

#include "twin/core/errors.h"
#include "twin/core/units.h"

namespace twinbench::report {
namespace {

struct Entry {
  double position_deg, correction_deg;
};

/// The whole turn with both ends.
std::vector<Entry> EntriesOf(const CompensationTable& table) {
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < table.position_rad.size(); ++i)
    entries.push_back({table.position_rad[i] / units::deg, table.correction_rad[i] / units::deg});
  if (entries.front().position_deg > 0.0) entries.insert(entries.begin(), {0.0, table.At(0.0) / units::deg});
  entries.push_back({360.0, table.At(0.0) / units::deg});
  return entries;
}

std::string Commented(const std::string& mark, const std::vector<std::string>& comments) {
  std::string text;
  for (const std::string& comment : comments) text += fmt::format("{} {}\n", mark, comment);
  return text;
}

/// The controller stops reading at the first line that is no triplet, so that nothing else may stand in the file.
std::string LinuxCnc(const std::vector<Entry>& entries) {
  std::string text;
  for (const auto& [position_deg, correction_deg] : entries) {
    const double actual_deg = position_deg - correction_deg;
    text += fmt::format("{:.9f} {:.9f} {:.9f}\n", position_deg, actual_deg, actual_deg);
  }
  return text;
}

std::string TwinCat(const std::vector<Entry>& entries, const std::string& axis,
                    const std::vector<std::string>& comments) {
  std::string text = Commented("//", comments);
  text += "// Compensation is added to the set position; try one entry on the axis before all of them.\nVAR\n";
  text += fmt::format("  aCompensation{} : ARRAY[1..{}] OF ST_PositionCompensationTableElement := [\n", axis,
                      entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    text += fmt::format("    (Position := {:.9f}, Compensation := {:.9f}){}\n", entries[i].position_deg,
                        entries[i].correction_deg, i + 1 < entries.size() ? "," : "];");
  }
  text += fmt::format(
      "  stCompensation{} : ST_PositionCompensationTableParameter := (MinPosition := 0.0, "
      "MaxPosition := 360.0, NoOfTableElements := {}, Direction := WorkDirectionBoth, "
      "Modulo := TRUE);\nEND_VAR\n",
      axis, entries.size());
  return text;
}

std::string Heidenhain(const std::vector<Entry>& entries, const std::string& axis) {
  std::string text =
      fmt::format("BEGIN {}.COM\n{:<6}{:>16}{:>12}{:>16}\n", axis, "NR", "AXISPOS", "BACKLASH", axis);
  for (std::size_t i = 0; i < entries.size(); ++i)
    text += fmt::format("{:<6}{:>+16.9f}{:>+12.1f}{:>+16.9f}\n", i, entries[i].position_deg, 0.0,
                        entries[i].correction_deg);
  return text + "[END]\n";
}

}  // namespace

const std::vector<ControllerForm>& ControllerForms() {
  // 256 entries: EMCMOT_COMP_SIZE of LinuxCNC, and what a .COM table of a TNC may have.
  static const std::vector<ControllerForm> forms = {
      {"plain", "position_deg,correction_arcsec: what compensation_file of a scenario reads", 0},
      {"linuxcnc", "triplets for [JOINT_n] COMP_FILE with COMP_FILE_TYPE = 0, in degrees", 256},
      {"twincat", "Structured Text for MC_TableBasedPositionCompensation, in degrees", 0},
      {"heidenhain", "columns of a .COM table, in degrees", 256}};
  return forms;
}

const ControllerForm& ControllerFormNamed(const std::string& name) {
  std::string known;
  for (const ControllerForm& form : ControllerForms()) {
    if (form.name == name) return form;
    known += (known.empty() ? "" : ", ") + form.name;
  }
  throw InputError("--form " + name, "no controller's table has this form", "one of " + known);
}

std::string ControllerTable(const std::string& form, const CompensationTable& table, const std::string& axis,
                            const std::vector<std::string>& comments) {
  const ControllerForm& chosen = ControllerFormNamed(form);
  if (chosen.name == "plain") return CompensationCsv(table, comments);
  const std::vector<Entry> entries = EntriesOf(table);
  const auto count = static_cast<int>(entries.size());
  if (chosen.most_points > 0 && count > chosen.most_points) {
    throw InputError("--form " + form, fmt::format("{} entries with both ends of the turn", count),
                     fmt::format("at most {}: --points {}", chosen.most_points, chosen.most_points - 1));
  }
  if (chosen.name == "linuxcnc") return LinuxCnc(entries);
  if (chosen.name == "twincat") return TwinCat(entries, axis, comments);
  return Heidenhain(entries, axis);
}

}  // namespace twinbench::report
