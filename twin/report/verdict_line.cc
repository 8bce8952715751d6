#include "twin/report/verdict_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <vector>

#include "twin/diagnose/cause_groups.h"
#include "twin/diagnose/words.h"
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

/// " or order 59": of a cause of which the same readings show other orders.
std::string OtherOrder(const Cause& cause) {
  const auto other = std::ranges::find_if(cause.indistinguishable_from, [&](const diagnose::Rival& rival) {
    return rival.effect == cause.effect && rival.where != cause.where && rival.where.starts_with("order ");
  });
  return other == cause.indistinguishable_from.end() ? "" : " or " + other->where;
}

/// "backlash, width 0.0120 ± 0.0003 deg (97 %)".
std::string Alone(const Cause& cause, bool with_size) {
  std::string size;
  if (with_size && !cause.parameters.empty() && std::isfinite(cause.parameters.front().value))
    size = ", " + diagnose::NameAndSize(cause.parameters.front()) + OtherOrder(cause);
  return fmt::format("{}{} ({})", NameOf(cause), size, diagnose::Percent(cause.probability));
}

/// "a (61 %) or b (39 %)", "a, b or c (33 % each)".
std::string Together(const std::vector<Cause>& causes, const diagnose::CauseGroup& group) {
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

std::string ShortOf(const std::vector<Cause>& causes, const diagnose::CauseGroup& group) {
  const Cause& first = causes[group.front()];
  const std::string name = fmt::format("{} ({})", NameOf(first), diagnose::Percent(first.probability));
  if (group.size() == 1) return name;
  return fmt::format("{} or {} other{}", name, group.size() - 1, group.size() == 2 ? "" : "s");
}

/// As many groups as fit into `most` characters.
std::string Causes(const Diagnosis& d, const std::vector<diagnose::CauseGroup>& groups, bool with_sizes,
                   std::size_t most = std::string::npos) {
  std::string text;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::string more = fmt::format("; and {} more", groups.size() - g);
    const std::size_t rest = g + 1 < groups.size() ? more.size() : 0;
    std::string part =
        groups[g].size() == 1 ? Alone(d.causes[groups[g].front()], with_sizes) : Together(d.causes, groups[g]);
    if (text.size() + 2 + part.size() + rest > most) part = ShortOf(d.causes, groups[g]);
    if (g > 0 && text.size() + 2 + part.size() + rest > most) return text + more;
    text += (g > 0 ? "; " : "") + part;
  }
  return text;
}

/// What is less likely than not is in the table: a headline says what was found, if anything was.
std::vector<diagnose::CauseGroup> Likely(const std::vector<Cause>& causes, std::vector<diagnose::CauseGroup> groups) {
  constexpr double kHalf = 0.5;
  const auto is_likely = [&](const diagnose::CauseGroup& group) {
    double probability = 0.0;
    for (const std::size_t k : group) probability += causes[k].probability;
    return probability >= kHalf;
  };
  if (std::ranges::any_of(groups, is_likely)) std::erase_if(groups, std::not_fn(is_likely));
  return groups;
}

std::string ShortSource(const std::string& source) {
  if (WidthOf(source) <= kLongestSource) return source;
  const std::filesystem::path path(source);
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

}  // namespace

std::string VerdictLine(const Diagnosis& d, const std::string& source, const std::vector<double>& share) {
  const std::vector<diagnose::CauseGroup> groups = Likely(d.causes, GroupsByShare(d.causes, share));
  const std::string name = ShortSource(source), of = fmt::format("{} reading{} of {}", d.readings, d.readings == 1 ? "" : "s", name);
  const auto line = [&](const std::string& verdict) {
    for (const bool with_sizes : {true, false}) {
      for (const std::string& place : {of, name}) {
        const std::string text = fmt::format("{}: {} in {}", verdict, Causes(d, groups, with_sizes), place);
        if (WidthOf(text) <= kLongest) return text;
      }
    }
    const std::size_t taken = verdict.size() + 6 + name.size();  // ": " and " in "
    return fmt::format("{}: {} in {}", verdict, Causes(d, groups, true, kLongest - std::min(kLongest, taken)), name);
  };
  switch (d.verdict) {
    case Verdict::kNamed:
      return line("Cause identified");
    case Verdict::kTie:
      return line("Ambiguous");
    case Verdict::kUnknown:
      return fmt::format("Unmodelled effect: explained by no cause of the catalogue ({}) in {}",
                         diagnose::Percent(d.unknown.probability), of);
    case Verdict::kNone:
      break;
  }
  return fmt::format("Consistent with the scenario: nothing found in {}{}", of,
                     std::isfinite(d.alarm_p) ? fmt::format(" (p = {:.2g})", d.alarm_p) : "");
}

}  // namespace twinbench::report
