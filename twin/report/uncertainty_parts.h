#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace twinbench::report {

/// Variance that one source leaves of each value of a list, in the unit of the list's u^2.
struct VariancePart {
  std::string name;  // "noise", "quantisation", "repeatability", "drift", "standard", "second order", "model", ...
  std::vector<double> variance;
};

/// `u_parts` of results.json (uncertainty::Quantity): the share that each part has of u^2, a list of as many as
/// `u2`. Parts that are zero throughout are left out.
///
/// The parts are estimates of their own: that they add up to u^2 is for the estimator to see to.
nlohmann::json PartsJson(const std::vector<double>& u2, const std::vector<VariancePart>& parts);

/// The same where the parts are alike for a whole list: numbers.
nlohmann::json PartsJson(const std::vector<std::pair<std::string, double>>& shares);

}  // namespace twinbench::report
