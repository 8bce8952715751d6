#include "twin/report/page/scored.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "twin/report/page/named_numbers.h"

namespace twinbench::report {

namespace {

/// Puts a number where it belongs in its list: values that could not be scored have no number.
void PutAt(nlohmann::json& list, std::size_t place, double number) {
  if (!list.is_array()) list = nlohmann::json::array();
  while (list.size() <= place) list.push_back(nullptr);
  if (std::isfinite(number)) list[place] = number;
}

}  // namespace

nlohmann::json ScoredValuesJson(const std::vector<ScoredValue>& values) {
  nlohmann::json lists = nlohmann::json::object();
  for (const ScoredValue& scored : values) {
    const std::size_t bracket = scored.name.rfind('[');
    const bool in_list = bracket != std::string::npos && scored.name.ends_with(']');
    const std::size_t place = in_list ? std::stoul(scored.name.substr(bracket + 1)) : 0;
    nlohmann::json& list = lists[in_list ? scored.name.substr(0, bracket) : scored.name];
    PutAt(list["value"], place, scored.value);
    PutAt(list["u"], place, scored.u);
    PutAt(list["truth"], place, scored.truth);
  }
  return lists;
}

std::vector<double> TruthOf(const nlohmann::json& score, const std::string& path, std::size_t size) {
  if (!score.is_object() || !score.contains("values") || !score.at("values").is_object()) return {};
  for (const auto& [name, list] : score.at("values").items()) {
    if (path != name && !path.ends_with("." + name)) continue;
    const auto truth = NumbersAt(list, "truth");
    if (truth && truth->size() == size) return *truth;
  }
  return {};
}

}  // namespace twinbench::report
