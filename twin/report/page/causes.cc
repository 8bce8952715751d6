#include "twin/report/page/causes.h"

#include <fmt/format.h>

#include "twin/report/page/named_numbers.h"

namespace twinbench::report {

nlohmann::json ListAt(const nlohmann::json& object, const std::string& key) {
  return object.is_object() && object.contains(key) && object.at(key).is_array() ? object.at(key) : nlohmann::json::array();
}

std::string NameOfCause(const nlohmann::json& cause) {
  const std::string where = TextAt(cause, "where");
  return TextAt(cause, "effect") + (where.empty() ? "" : " at " + where);
}

PageTable DetectableTable(const nlohmann::json& seen) {
  PageTable table{"Smallest sizes that this run would show", {"effect", "parameter", "smallest", "unit"}, {}};
  for (const nlohmann::json& one : ListAt(seen, "detectable")) {
    const std::string unit = TextAt(one, "unit");
    table.rows.push_back({NameOfCause(one), NameAndUnit(TextAt(one, "parameter")).name,
                          fmt::format("{:.3g}", NumberAt(one, "smallest")), unit == "1" ? "" : unit});
  }
  return table;
}

PageTable InvisibleTable(const nlohmann::json& seen) {
  PageTable table{"What this run cannot see", {"effect", "could bias"}, {}};
  for (const nlohmann::json& lost : ListAt(seen, "invisible")) table.rows.push_back({NameOfCause(lost), TextAt(lost, "could_bias")});
  return table;
}

void AddFilled(PageTable table, PageSection& section) {
  if (!table.rows.empty()) section.blocks.emplace_back(std::move(table));
}

}  // namespace twinbench::report
