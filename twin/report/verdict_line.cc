#include "twin/report/verdict_line.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "twin/diagnose/words.h"
#include "twin/report/cause_groups.h"
#include "twin/report/text_table.h"

namespace twinbench::report {
namespace {

using diagnose::Cause;
using diagnose::Diagnosis;
using diagnose::Verdict;

constexpr std::size_t kLongest = 98;
constexpr std::size_t kLongestSource = 24;

std::string NameOf(const Cause& cause) {
  return diagnose::Place(cause.effect, cause.where);
}

/// "backlash, width 0.0120 +- 0.0003 deg (97 %)".
std::string Alone(const Cause& cause) {
  std::string size;
  if (!cause.parameters.empty() && std::isfinite(cause.parameters.front().value))
    size = ", " + diagnose::NameAndSize(cause.parameters.front());
  return fmt::format("{}{} ({})", NameOf(cause), size, diagnose::Percent(cause.probability));
}

/// "a (61 %) or b (39 %)", "a, b or c (33 % each)".
std::string Together(const std::vector<Cause>& causes, const CauseGroup& group) {
  const std::string first = diagnose::Percent(causes[group.front()].probability);
  bool are_even = true;
  for (const std::size_t k : group) are_even &= diagnose::Percent(causes[k].probability) == first;
  std::string text;
  for (std::size_t i = 0; i < group.size(); ++i) {
    const Cause& cause = causes[group[i]];
    text += (i == 0 ? "" : i + 1 < group.size() ? ", " : " or ") + NameOf(cause);
    if (!are_even) text += fmt::format(" ({})", diagnose::Percent(cause.probability));
  }
  return are_even ? fmt::format("{} ({} each)", text, first) : text;
}

std::string ShortOf(const std::vector<Cause>& causes, const CauseGroup& group) {
  const Cause& first = causes[group.front()];
  const std::string name = fmt::format("{} ({})", NameOf(first), diagnose::Percent(first.probability));
  return group.size() == 1 ? name : fmt::format("{} or one of {} others", name, group.size() - 1);
}

/// As many groups as there is room for.
std::string Causes(const Diagnosis& d, std::size_t room) {
  const std::vector<CauseGroup> groups = GroupsOf(d.causes);
  std::string text;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::string more = fmt::format("; and {} more", groups.size() - g);
    const std::size_t rest = g + 1 < groups.size() ? more.size() : 0;
    std::string part = groups[g].size() == 1 ? Alone(d.causes[groups[g].front()]) : Together(d.causes, groups[g]);
    if (text.size() + 2 + part.size() + rest > room) part = ShortOf(d.causes, groups[g]);
    if (g > 0 && text.size() + 2 + part.size() + rest > room) return text + more;
    text += (g > 0 ? "; " : "") + part;
  }
  return text;
}

std::string ShortSource(const std::string& source) {
  if (WidthOf(source) <= kLongestSource) return source;
  const std::filesystem::path path(source);
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

}  // namespace

std::string VerdictLine(const Diagnosis& d, const std::string& source) {
  const std::string of = fmt::format("{} readings of {}", d.readings, ShortSource(source));
  const auto line = [&of](const std::string& verdict, const auto& causes) {
    const std::size_t taken = verdict.size() + 6 + of.size();  // ": " and " in "
    return fmt::format("{}: {} in {}", verdict, causes(kLongest - std::min(kLongest, taken)), of);
  };
  const auto causes = [&d](std::size_t room) { return Causes(d, room); };
  switch (d.verdict) {
    case Verdict::kNamed:
      return line("Named", causes);
    case Verdict::kTie:
      return line("Tie", causes);
    case Verdict::kUnknown:
      return line("Unknown", [&d](std::size_t) {
        return fmt::format("structure that no cause of the catalogue explains ({})",
                           diagnose::Percent(d.unknown.probability));
      });
    case Verdict::kNone:
      break;
  }
  return fmt::format("Agrees: nothing found in {}{}", of,
                     std::isfinite(d.alarm_p) ? fmt::format(" (p = {:.2g})", d.alarm_p) : "");
}

}  // namespace twinbench::report
