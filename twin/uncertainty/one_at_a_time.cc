#include "twin/uncertainty/one_at_a_time.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"

namespace twinbench::uncertainty {
namespace {

std::vector<double> ValuesOf(const std::vector<Figure>& figures) {
  std::vector<double> values;
  for (const Figure& figure : figures) values.push_back(figure.value);
  return values;
}

/// @param keep  Which one stays; -1: none.
Scenario Silent(Scenario scenario, const std::vector<Contribution>& contributions, int keep) {
  for (std::size_t k = 0; k < contributions.size(); ++k) {
    if (static_cast<int>(k) != keep && !contributions[k].stays) contributions[k].silence(scenario);
  }
  return scenario;
}

Scenario Without(Scenario scenario, const Contribution& contribution) {
  contribution.silence(scenario);
  return scenario;
}

}  // namespace

double OneAtATime::InQuadrature(std::size_t figure) const {
  const double floor2 = none[figure] * none[figure];
  double sum2 = floor2;
  for (const Share& share : shares) {
    if (!share.alone.empty()) sum2 += std::max(0.0, share.alone[figure] * share.alone[figure] - floor2);
  }
  return std::sqrt(sum2);
}

OneAtATime RunOneAtATime(const Scenario& scenario, const std::vector<Contribution>& contributions,
                         const RunFigures& run) {
  OneAtATime result;
  result.total = run(scenario);
  const auto values = [&](const Scenario& s) {
    std::vector<double> of = ValuesOf(run(s));
    Require(of.size() == result.total.size(), "a run that is more silent has as many figures");
    return of;
  };
  const std::vector<double> total = ValuesOf(result.total);
  result.none = values(Silent(scenario, contributions, -1));
  for (std::size_t k = 0; k < contributions.size(); ++k) {
    std::vector<double> without = values(Without(scenario, contributions[k]));
    if (without == total) continue;
    Share share{contributions[k].name, {}, std::move(without)};
    if (!contributions[k].stays) share.alone = values(Silent(scenario, contributions, static_cast<int>(k)));
    result.shares.push_back(std::move(share));
  }
  return result;
}

}  // namespace twinbench::uncertainty
