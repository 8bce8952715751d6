#include "twin/diagnose/engine/posterior.h"

#include <algorithm>
#include <cmath>

#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

std::vector<Share> Ranked(const Posterior& posterior) {
  std::vector<Share> ranked(posterior.named.begin(), posterior.named.end());
  std::ranges::stable_sort(ranked, [](const Share& a, const Share& b) { return a.second > b.second; });
  return ranked;
}

std::vector<Share> SmallestSet(const std::vector<Share>& ranked, double unknown) {
  std::vector<Share> set;
  double sum = 0.0;
  for (const Share& share : ranked) {
    if (!set.empty() && (sum >= tuning::kTieFrom * (1.0 - unknown) || share.second < tuning::kWorthListing)) break;
    set.push_back(share);
    sum += share.second;
  }
  return set;
}

}  // namespace

Posterior PosteriorOf(const Term& term, const std::vector<Family>& families) {
  Posterior posterior;
  for (int k = 0; k < std::ssize(families); ++k) {
    const Family& family = families[static_cast<std::size_t>(k)];
    const double p = std::exp(term.log_posterior[k]);
    if (family.kind == Kind::kNamed) {
      posterior.named[{family.effect, family.where}] += p;
      continue;
    }
    posterior.unknown += p;
    const bool first = posterior.best_unknown < 0;
    if (first || term.log_posterior[k] > term.log_posterior[posterior.best_unknown]) posterior.best_unknown = k;
  }
  return posterior;
}

std::vector<Share> CredibleSet(const Posterior& posterior) {
  std::vector<Share> ranked = Ranked(posterior);
  if (ranked.empty() || ranked.front().second < tuning::kNamedFrom) return SmallestSet(ranked, posterior.unknown);
  return {ranked.front()};
}

std::vector<Share> Outside(const std::vector<Share>& set, const Posterior& posterior, double least) {
  std::vector<Share> ranked = Ranked(posterior);
  ranked.erase(ranked.begin(), ranked.begin() + std::ssize(set));
  std::erase_if(ranked, [least](const Share& share) { return share.second < least; });
  return ranked;
}

}  // namespace twinbench::diagnose
