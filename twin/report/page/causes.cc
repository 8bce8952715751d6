#include "twin/report/page/causes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "twin/report/page/named_numbers.h"
#include "twin/report/sound.h"

namespace twinbench::report {
namespace {

using nlohmann::json;

std::string ParametersOf(const json& cause) {
  std::string text;
  if (!cause.contains("parameters")) return text;
  for (const auto& [name, p] : cause.at("parameters").items()) {
    const double u = NumberAt(p, "u");
    if (!IsDetermined(u, NumberAt(p, "lower"), NumberAt(p, "upper"))) continue;
    text += (text.empty() ? "" : ", ") + NameAndUnit(name).name + " " +
            MeasuredText(NumberAt(p, "value"), u, TextAt(p, "unit"));
  }
  return text;
}

double ProbabilityOf(const json& cause) {
  const double probability = NumberAt(cause, "probability");
  return std::isfinite(probability) ? probability : 0.0;
}

bool AreAlike(const json& cause, const json& other) {
  return std::ranges::any_of(ListAt(cause, "indistinguishable_from"),
                             [&](const json& rival) { return NameOfCause(rival) == NameOfCause(other); });
}

/// The share of each; empty if the file does not say.
std::vector<double> SharesOf(const json& diagnosis) {
  if (!diagnosis.contains("plots")) return {};
  return NumbersAt(diagnosis.at("plots"), "share").value_or(std::vector<double>());
}

}  // namespace

nlohmann::json ListAt(const nlohmann::json& object, const std::string& key) {
  return object.is_object() && object.contains(key) && object.at(key).is_array() ? object.at(key)
                                                                                 : nlohmann::json::array();
}

std::string NameOfCause(const nlohmann::json& cause) {
  const std::string where = TextAt(cause, "where");
  return TextAt(cause, "effect") + (where.empty() ? "" : " at " + where);
}

PageTable DetectableTable(const nlohmann::json& seen) {
  PageTable table{"Smallest detectable sizes", {"effect", "parameter", "smallest", "unit"}, {}};
  for (const nlohmann::json& one : ListAt(seen, "detectable")) {
    const std::string unit = TextAt(one, "unit");
    table.rows.push_back({NameOfCause(one), NameAndUnit(TextAt(one, "parameter")).name,
                          fmt::format("{:.3g}", NumberAt(one, "smallest")), unit == "1" ? "" : UnitText(unit)});
  }
  return table;
}

PageTable InvisibleTable(const nlohmann::json& seen) {
  PageTable table{"Not observable in this run", {"effect", "could bias"}, {}};
  for (const nlohmann::json& lost : ListAt(seen, "invisible"))
    table.rows.push_back({NameOfCause(lost), InPrint(TextAt(lost, "could_bias"))});
  return table;
}

void AddFilled(PageTable table, PageSection& section) {
  if (!table.rows.empty()) section.blocks.emplace_back(std::move(table));
}

std::string Percent(double share) {
  if (share > 0.0 && share < 0.001) return "< 0.1 %";
  return std::isfinite(share) ? fmt::format("{:.3g} %", 100.0 * share) : "";
}

std::vector<CauseGroup> GroupsOf(const json& diagnosis) {
  const json causes = ListAt(diagnosis, "causes");
  const std::vector<double> shares = SharesOf(diagnosis);
  std::vector<CauseGroup> groups;
  std::vector<std::size_t> first;  // of each group
  for (std::size_t k = 0; k < causes.size(); ++k) {
    const json& cause = causes[k];
    const double share = k < shares.size() ? shares[k] : kNaN;
    // Only one of a group is there: together they are no more probable than that.
    const auto is_of = [&](std::size_t f) {
      const double together =
          groups[static_cast<std::size_t>(std::ranges::find(first, f) - first.begin())].probability +
          ProbabilityOf(cause);
      return together <= 1.000001 && (AreAlike(causes[f], cause) || AreAlike(cause, causes[f]));
    };
    const auto of = std::ranges::find_if(first, is_of);
    if (of == first.end()) {
      first.push_back(k);
      groups.push_back({NameOfCause(cause), ParametersOf(cause), TextAt(cause, "next_measurement"),
                        ProbabilityOf(cause), share});
      continue;
    }
    CauseGroup& group = groups[static_cast<std::size_t>(of - first.begin())];
    group.name += " or " + NameOfCause(cause);
    if (const std::string size = ParametersOf(cause); !size.empty())
      group.size += (group.size.empty() ? "" : "; or ") + size;
    if (group.next.empty()) group.next = TextAt(cause, "next_measurement");
    group.probability += ProbabilityOf(cause);
    if (!std::isfinite(group.share)) group.share = share;
  }
  std::ranges::stable_sort(groups, std::greater(), [](const CauseGroup& group) {
    return std::isfinite(group.share) ? group.share : group.probability - 1.0;  // behind those with a share
  });
  return groups;
}

}  // namespace twinbench::report
