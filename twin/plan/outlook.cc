#include "twin/plan/outlook.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/plan/harmonics.h"

namespace twinbench::plan {
namespace {

std::vector<Certainty> CertaintiesOf(const nlohmann::json& results) {
  std::vector<Certainty> all;
  for (const uncertainty::Quantity& quantity : uncertainty::QuantitiesOf(results)) {
    const std::string name = uncertainty::KindOf(quantity.name);
    auto one = std::ranges::find(all, name, &Certainty::name);
    if (one == all.end()) one = all.insert(all.end(), Certainty{name, 0, 0.0, 0.0});
    ++one->values;
    one->rms_u += quantity.u * quantity.u;
    one->worst_u = std::max(one->worst_u, quantity.u);
  }
  for (Certainty& one : all) one.rms_u = std::sqrt(one.rms_u / static_cast<double>(one.values));
  return all;
}

/// Lists of words, or of what and why.
void TakeLost(const nlohmann::json& separation, Outlook& outlook) {
  if (!separation.is_object() || !separation.contains("not_separable")) return;
  outlook.separates = true;
  for (const auto& one : separation.at("not_separable")) {
    if (one.is_string()) {
      outlook.lost.push_back(one.get<std::string>());
      outlook.not_separable.push_back(outlook.lost.back());
    } else if (one.contains("what") && one.contains("why")) {
      outlook.lost.push_back(one.at("what").get<std::string>());
      outlook.not_separable.push_back(outlook.lost.back() + ": " + one.at("why").get<std::string>());
    }
  }
}

/// Where the bench says what it cannot separate: of the whole run where nothing is a separation by name.
const nlohmann::json& SeparationOf(const nlohmann::json& results) {
  return results.contains("separation") && results.at("separation").is_object() ? results.at("separation") : results;
}

}  // namespace

Outlook OutlookOf(const nlohmann::json& results, int readings, double last_s) {
  Outlook outlook;
  outlook.readings = readings;
  constexpr double kMinute_s = 60.0;
  outlook.minutes = last_s / kMinute_s;
  outlook.dof = std::nan("");
  outlook.results = CertaintiesOf(results);
  outlook.harmonics = HarmonicsOf(results);
  const nlohmann::json& separation = SeparationOf(results);
  TakeLost(separation, outlook);
  if (separation.contains("dof") && separation.at("dof").is_number()) outlook.dof = separation.at("dof").get<double>();
  return outlook;
}

Outlook MeanOf(const std::vector<Outlook>& runs) {
  Outlook mean = runs.front();
  const auto mean_of = [&runs](auto u_in) {
    double sum = 0.0, count = 0.0;
    for (const Outlook& run : runs) {
      const double u = u_in(run);
      if (!std::isfinite(u)) continue;
      sum += u * u;
      ++count;
    }
    return count > 0.0 ? std::sqrt(sum / count) : std::nan("");
  };
  for (Certainty& result : mean.results) {
    result.rms_u = mean_of([&](const Outlook& run) {
      const auto same = std::ranges::find(run.results, result.name, &Certainty::name);
      return same == run.results.end() ? std::nan("") : same->rms_u;
    });
  }
  for (std::size_t c = 0; c < mean.harmonics.size(); ++c) {
    for (std::size_t k = 0; k < mean.harmonics[c].u.size(); ++k) {
      mean.harmonics[c].u[k] = mean_of([&](const Outlook& run) {
        const bool has = c < run.harmonics.size() && run.harmonics[c].orders == mean.harmonics[c].orders;
        return has ? run.harmonics[c].u[k] : std::nan("");
      });
    }
  }
  return mean;
}

namespace {

bool IsPhase(const std::string& result) {
  return result.find("phase") != std::string::npos;
}

/// rms uncertainty of one result in those runs that have it.
Eigen::ArrayXd RmsIn(const std::vector<Outlook>& runs, const std::string& result) {
  std::vector<double> all;
  for (const Outlook& run : runs) {
    const auto same = std::ranges::find(run.results, result, &Certainty::name);
    if (same != run.results.end()) all.push_back(same->rms_u);
  }
  return Eigen::Map<const Eigen::ArrayXd>(all.data(), std::ssize(all));
}

}  // namespace

double LargestDifference(const Outlook& a, const Outlook& b) {
  double largest = 0.0;
  for (const Certainty& result : a.results) {
    if (IsPhase(result.name)) continue;
    const auto same = std::ranges::find(b.results, result.name, &Certainty::name);
    if (same != b.results.end() && result.rms_u > 0.0)
      largest = std::max(largest, std::abs(same->rms_u / result.rms_u - 1.0));
  }
  return largest;
}

double UncertaintyOfMean(const std::vector<Outlook>& runs) {
  double largest = 0.0;
  for (const Certainty& result : runs.front().results) {
    const Eigen::ArrayXd u = RmsIn(runs, result.name);
    if (IsPhase(result.name) || u.size() < 2 || !(u.mean() > 0.0)) continue;
    const auto count = static_cast<double>(u.size());
    largest = std::max(largest, std::sqrt((u - u.mean()).square().sum() / (count - 1.0) / count) / u.mean());
  }
  return largest;
}

}  // namespace twinbench::plan
