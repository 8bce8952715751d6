#include "twin/plan/unseen.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "twin/uncertainty/quantities.h"

namespace twinbench::plan {
namespace {

struct MovedBy {
  double moved2 = 0.0, u2 = 0.0;
  int values = 0;
};

/// A phase comes round.
double Moved(const std::string& name, double from, double to) {
  constexpr double kTurn_deg = 360.0;
  const bool is_phase = name.find("phase_deg") != std::string::npos;
  return is_phase ? std::remainder(to - from, kTurn_deg) : to - from;
}

}  // namespace

std::vector<Bias> BiasesOf(const nlohmann::json& without, const nlohmann::json& with) {
  std::map<std::string, double> after;
  for (const uncertainty::Quantity& q : uncertainty::QuantitiesOf(with)) after[q.name] = q.value;
  std::map<std::string, MovedBy> sums;
  for (const uncertainty::Quantity& q : uncertainty::QuantitiesOf(without)) {
    const auto found = after.find(q.name);
    if (found == after.end() || !(q.u > 0.0)) continue;
    MovedBy& one = sums[uncertainty::KindOf(q.name)];
    const double moved = Moved(q.name, q.value, found->second);
    one.moved2 += moved * moved;
    one.u2 += q.u * q.u;
    ++one.values;
  }
  std::vector<Bias> biases;
  for (const auto& [name, one] : sums)
    biases.push_back({name, std::sqrt(one.moved2 / one.values), std::sqrt(one.moved2 / one.u2)});
  std::ranges::stable_sort(biases, std::ranges::greater{}, &Bias::per_u);
  return biases;
}

}  // namespace twinbench::plan
