#include "tools/twinbench/campaign_table.h"

#include <filesystem>
#include <nlohmann/json.hpp>

namespace twinbench::tools {

campaign::Table OpenTable(const std::string& path, const campaign::Study& study, bool resume) {
  const bool goes_on = resume && std::filesystem::exists(path);
  return goes_on ? campaign::Table::Continue(path, TWINBENCH_VERSION, study) : campaign::Table::Create(path, TWINBENCH_VERSION, study);
}

nlohmann::json SummaryJson(const campaign::Summary& summary) {
  constexpr std::size_t kMostWorst = 10;
  nlohmann::json json = {{"trials", summary.Trials()},
                         {"lost", nlohmann::json::array()},
                         {"verdicts", summary.Verdicts()},
                         {"results", nlohmann::json::object()},
                         {"worst", nlohmann::json::array()}};
  for (const campaign::TrialRow& row : summary.Lost()) json["lost"].push_back({{"trial", row.trial}, {"failure", row.failure}});
  for (const auto& [name, r] : summary.Results())
    json["results"][name] = {{"count", r.count}, {"mean", r.mean}, {"sd", r.sd}, {"rms_u", r.rms_u}, {"scored", r.scored}, {"rms_error", r.rms_error}, {"bias", r.bias}, {"coverage95", r.coverage95}};
  for (const campaign::WorstTrial& worst : summary.Worst(kMostWorst))
    json["worst"].push_back({{"trial", worst.trial}, {"result", worst.result}, {"error_over_u", worst.normed}});
  return json;
}

}  // namespace twinbench::tools
