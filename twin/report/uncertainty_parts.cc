#include "twin/report/uncertainty_parts.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace twinbench::report {
namespace {

nlohmann::json ShareOf(double variance, double u2) {
  return u2 > 0.0 && std::isfinite(variance) ? nlohmann::json(variance / u2) : nlohmann::json();
}

}  // namespace

nlohmann::json PartsJson(const std::vector<double>& u2, const std::vector<VariancePart>& parts) {
  nlohmann::json json = nlohmann::json::object();
  for (const VariancePart& part : parts) {
    if (std::ranges::none_of(part.variance, [](double v) { return v > 0.0; })) continue;
    nlohmann::json shares = nlohmann::json::array();
    for (std::size_t i = 0; i < u2.size(); ++i) shares.push_back(ShareOf(part.variance[i], u2[i]));
    json[part.name] = shares;
  }
  return json;
}

nlohmann::json PartsJson(const std::vector<std::pair<std::string, double>>& shares) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [name, share] : shares) {
    if (share > 0.0) json[name] = share;
  }
  return json;
}

}  // namespace twinbench::report
