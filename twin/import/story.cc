#include "twin/import/story.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "twin/core/reading_clock.h"
#include "twin/core/units.h"
#include "twin/import/blocks.h"
#include "twin/import/source.h"

namespace twinbench::imports {
namespace {

std::string InUnit(double rad, bool linear, double turn_m) {
  if (linear) return fmt::format("{:.6g} mm", rad / units::turn * turn_m / units::mm);
  return fmt::format("{:.6g} deg", rad / units::deg);
}

/// How the reference of a bench that compares went.
std::string CourseText(const Joined& joined, const Tally& tally) {
  const auto unit = [&](double rad) { return InUnit(rad, joined.linear, joined.turn_m); };
  std::string text =
      tally.low == tally.high
          ? fmt::format("the reference stands at {}{}", unit(tally.low), joined.sessions[0].has_clock ? "" : ", reached from both sides")
          : fmt::format("the reference goes from {} to {} ({:.4g} turns)", unit(tally.low), unit(tally.high), (tally.high - tally.low) / units::turn);
  text += fmt::format(", {} reversals, {} fly-backs, {} rests", tally.reversals, tally.fly_backs, tally.rests);
  if (tally.fastest > 0.0)
    text += fmt::format(", usual top speed {}/s, at rest {:.1f} % of the rows", unit(tally.fastest), 100.0 * tally.rest_share);
  text += "\n";
  if (tally.wraps > 0) text += fmt::format("the reference starts again {} times: it was unwrapped\n", tally.wraps);
  return text + (tally.stops ? "taken as stops: every row, or every rest, is a reading at rest (course.kind)\n"
                             : "taken as motion that is read while it goes on (course.kind)\n");
}

/// "2 passes: 360 readings in direction 1, 360 in direction -1".
std::string PassesText(const std::vector<Reading>& readings) {
  constexpr std::size_t kMostTold = 12;
  std::vector<std::vector<Reading>::const_iterator> begins;
  for (auto r = readings.begin(); r != readings.end(); ++r) {
    if (r == readings.begin() || std::tie(r->setup, r->pass) != std::tie(std::prev(r)->setup, std::prev(r)->pass)) begins.push_back(r);
  }
  begins.push_back(readings.end());
  std::string text = fmt::format("{} pass{}: ", begins.size() - 1, begins.size() == 2 ? "" : "es");
  for (std::size_t k = 0; k + 1 < std::min(begins.size(), kMostTold); ++k)
    text += fmt::format("{}{} readings in direction {}", k == 0 ? "" : ", ", begins[k + 1] - begins[k], begins[k]->direction);
  return text + (begins.size() > kMostTold ? ", ...\n" : "\n");
}

}  // namespace

std::string StoryOf(const std::vector<Recording>& recordings, const Joined& joined, const Tally& tally,
                    const std::vector<std::string>& guessed, const Map& map, const Imported& imported) {
  std::string text;
  for (const Recording& recording : recordings)
    text += fmt::format("{}: {}\n", recording.file, recording.layout) + RemarksOn(recording);
  for (const MappedColumn& column : map.columns) {
    const std::string& unit = joined.unit.at(column.column);
    text += fmt::format("  {} <- {}{}\n", BaseOf(column.column), column.expression,
                        unit.empty() ? "" : " [" + unit + "]");
  }
  text += FormatOf(imported.bench).compared ? CourseText(joined, tally) : PassesText(imported.readings);
  text += HasClock(imported.readings) ? ClockText(recordings[0].tracks[0]) + "\n"
                                      : "no clock: the rows are in order, and no duration or rate is known\n";
  if (tally.widest > 0.0)
    text += fmt::format(
        "averaged in blocks of up to {} rows, never across a reversal, a rest or a gap: orders up to {} keep 99 "
        "%, largest and smallest values of single rows are lost\n",
        tally.usual_rows, HighestOrderKept(tally.widest));
  for (const auto* list : {&joined.left_out, &tally.left_out}) {
    for (const LeftOut& left_out : *list) text += fmt::format("left out: {} {}\n", left_out.count, left_out.why);
  }
  for (const auto* list : {&guessed, &joined.remarks, &tally.remarks, &tally.assumed}) {
    for (const std::string& remark : *list) text += "note: " + remark + "\n";
  }
  return text + fmt::format("{} readings of {} rows, {} mounting{}, bench {}\n", imported.readings.size(), tally.rows, joined.sessions.size(),
                            joined.sessions.size() == 1 ? "" : "s", imported.bench);
}

}  // namespace twinbench::imports
