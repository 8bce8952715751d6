#include <fmt/format.h>

#include "tests/hidden/score_format.h"
#include "tests/hidden/score_sections.h"

// Runs with nothing hidden in them.
namespace twinbench::hidden {
namespace {

std::string AlarmRow(const std::string& key, const Outcomes& group) {
  return fmt::format("| {} | {} | {} |\n", key, group.size(),
                     WithInterval(ShareOf(group, Graded(Grade::kFalseAlarm))));
}

}  // namespace

std::string AlarmSection(const Outcomes& all) {
  const Outcomes clean = Only(all, [](const Outcome& o) { return o.hidden.IsClean(); });
  return "## False alarms\n\n" + TableHead("set | noise | clean runs | alarms (95 % interval)") +
         RowsBySetAnd([](const Outcome& o) { return o.hidden.noise; }, clean, AlarmRow) + "\n";
}

}  // namespace twinbench::hidden
