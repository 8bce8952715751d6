#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "twin/import/common.h"
#include "twin/import/layouts.h"
#include "twin/import/text.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

/// A run's deviations by the number of the target, in the order in which they were read.
struct LaserRun {
  std::map<std::size_t, std::string_view> at;
  std::size_t first = 0, last = 0;  // targets

  const char* Way() const { return first < last ? " up" : first > last ? " down" : ""; }
};

struct LaserRuns {
  std::vector<std::string_view> targets;
  std::map<int, LaserRun> runs;
  std::string unit;  // of the deviations, where a line states it
  bool is_linear = false;
};

/// "Targets : 0.0 15.0 ...", in as many lines as they take.
void TakeTargets(std::string_view line, LaserRuns& read) {
  std::vector<std::string_view> fields;
  Split(line, ' ', fields);
  for (const std::string_view field : fields)
    if (FieldNumber(field, false)) read.targets.push_back(field);
}

void TakeDeviation(const std::vector<std::string_view>& fields, LaserRuns& read) {
  const auto run = FieldNumber(fields[0], false), target = FieldNumber(fields[1], false);
  if (!run || !target || !(*target >= 1.0) || !FieldNumber(fields[2], false)) return;
  LaserRun& own = read.runs[static_cast<int>(*run)];
  own.last = static_cast<std::size_t>(*target);
  if (own.at.empty()) own.first = own.last;
  own.at[own.last] = fields[2];
}

LaserRuns ReadLaserRuns(std::string_view text) {
  LaserRuns read;
  bool in_targets = false, in_deviations = false;
  std::vector<std::string_view> fields;
  Lines lines(text);
  for (std::string_view line; lines.Next(line);) {
    const std::size_t colon = line.find(':');
    const std::string_view value = colon == std::string_view::npos ? "" : Trimmed(line.substr(colon + 1));
    if (colon != std::string_view::npos) {
      const std::string key = SmallLetters(Trimmed(line.substr(0, colon)));
      in_targets = key == "targets";
      in_deviations = key == "run target data";
      if (in_targets) TakeTargets(value, read);
      if (key == "filetype") read.is_linear = SmallLetters(value).find("linear") != std::string::npos;
      if (key.starts_with("unit") && UnitNamed(value)) read.unit = value;
      continue;
    }
    Split(line, ' ', fields);
    if (in_targets) TakeTargets(line, read);
    if (in_deviations && fields.size() == 3) TakeDeviation(fields, read);
  }
  return read;
}

}  // namespace

bool AreLaserRuns(const std::vector<std::string_view>& lines) {
  const auto begins = [&lines](const char* what) { return std::ranges::any_of(lines, [what](std::string_view line) { return Trimmed(line).starts_with(what); }); };
  return begins("TARGET DATA::") && begins("Targets");
}

std::string TableOfLaserRuns(std::string_view text, std::vector<std::string>& said) {
  LaserRuns read = ReadLaserRuns(text);
  const bool is_said = !read.unit.empty();
  if (!is_said) read.unit = read.is_linear ? "mm" : "mrad";
  if (!is_said) said.push_back(fmt::format("the file says no unit of the deviations: taken as {}", read.unit));
  std::string table = read.is_linear ? "target [mm]" : "target [deg]";
  for (const auto& [number, run] : read.runs) table += fmt::format("\trun {}{} [{}]", number, run.Way(), read.unit);
  for (std::size_t k = 1; k <= read.targets.size(); ++k) {
    table += "\n" + std::string(read.targets[k - 1]);
    for (const auto& [number, run] : read.runs) table += "\t" + std::string(run.at.contains(k) ? run.at.at(k) : "");
  }
  return table + "\n";
}

}  // namespace twinbench::imports
