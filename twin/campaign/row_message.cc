#include "twin/campaign/row_message.h"

#include <nlohmann/json.hpp>

namespace twinbench::campaign {

std::vector<std::uint8_t> MessageOf(const TrialRow& row) {
  nlohmann::json results = nlohmann::json::array();
  for (const TrialResult& r : row.results) results.push_back({r.name, r.value, r.u, r.error, r.k});
  return nlohmann::json::to_cbor({row.trial, row.failure, row.verdict, results});
}

TrialRow RowOf(const std::vector<std::uint8_t>& message) {
  const nlohmann::json json = nlohmann::json::from_cbor(message);
  TrialRow row{json[0].get<std::int64_t>(), json[1].get<std::string>(), json[2].get<std::string>(), {}};
  for (const nlohmann::json& r : json[3])
    row.results.push_back({r[0].get<std::string>(), r[1].get<double>(), r[2].get<double>(), r[3].get<double>(),
                           r[4].get<double>()});
  return row;
}

}  // namespace twinbench::campaign
