#include "twin/plan/advice.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "twin/uncertainty/quantities.h"

namespace twinbench::plan {
namespace {

/// "target.ez" is the end of "separation.target.ez_arcsec", whose unit need not be told.
bool IsWanted(const std::string& kind, const std::string& wanted) {
  if (wanted.empty()) return true;
  for (const std::string& name : {kind, kind.substr(0, kind.rfind('_'))}) {
    if (!name.ends_with(wanted)) continue;
    if (name.size() == wanted.size() || name[name.size() - wanted.size() - 1] == '.') return true;
  }
  return false;
}

struct Variances {
  double before = 0.0, after = 0.0;
};

}  // namespace

std::vector<Gain> GainsOf(const nlohmann::json& before, const std::vector<const nlohmann::json*>& more, const std::string& wanted) {
  std::map<std::string, double> of_more;  // inverse variances
  for (const nlohmann::json* run : more)
    for (const uncertainty::Quantity& q : uncertainty::QuantitiesOf(*run))
      if (q.u > 0.0) of_more[q.name] += 1.0 / (q.u * q.u);
  std::map<std::string, Variances> kinds;
  std::map<std::string, bool> in_both;
  for (const uncertainty::Quantity& q : uncertainty::QuantitiesOf(before)) {
    const std::string kind = uncertainty::KindOf(q.name);
    if (!(q.u > 0.0) || !IsWanted(kind, wanted)) continue;
    const auto other = of_more.find(q.name);
    const bool has = other != of_more.end();
    const double variance = q.u * q.u;
    in_both[kind] = in_both[kind] || has;
    kinds[kind].before += variance;
    kinds[kind].after += has ? 1.0 / (1.0 / variance + other->second) : variance;
  }
  std::vector<Gain> gains;
  for (const auto& [kind, sum] : kinds) {
    if (in_both[kind]) gains.push_back({kind, std::sqrt(sum.after / sum.before)});
  }
  return gains;
}

std::vector<Gain> GainsOf(const nlohmann::json& before, const nlohmann::json& more, const std::string& wanted) {
  return GainsOf(before, std::vector<const nlohmann::json*>{&more}, wanted);
}

double MeanGain_bit(const std::vector<Gain>& gains) {
  double bits = 0.0;
  for (const Gain& gain : gains) bits -= std::log2(gain.ratio) / static_cast<double>(gains.size());
  return bits;
}

void Rank(std::vector<Advice>& advice) {
  std::ranges::stable_sort(advice, std::ranges::greater{}, &Advice::PerMinute);
}

}  // namespace twinbench::plan
