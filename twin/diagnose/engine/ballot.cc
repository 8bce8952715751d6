#include "twin/diagnose/engine/ballot.h"

#include <algorithm>
#include <cmath>

namespace twinbench::diagnose {
namespace {

constexpr double kNamedFrom = 0.8;
constexpr double kTieFrom = 0.95;
constexpr double kWorthListing = 0.02;

std::vector<Share> Ranked(const Ballot& ballot) {
  std::vector<Share> ranked(ballot.named.begin(), ballot.named.end());
  std::ranges::stable_sort(ranked, [](const Share& a, const Share& b) { return a.second > b.second; });
  return ranked;
}

std::vector<Share> SmallestSet(const std::vector<Share>& ranked, double unknown) {
  std::vector<Share> set;
  double sum = 0.0;
  for (const Share& share : ranked) {
    if (!set.empty() && (sum >= kTieFrom * (1.0 - unknown) || share.second < kWorthListing)) break;
    set.push_back(share);
    sum += share.second;
  }
  return set;
}

}  // namespace

Ballot CountVotes(const Pick& pick, const std::vector<Family>& families) {
  Ballot ballot;
  for (int k = 0; k < std::ssize(families); ++k) {
    const Family& family = families[static_cast<std::size_t>(k)];
    const double p = std::exp(pick.log_posterior[k]);
    if (family.kind == Kind::kNamed) {
      ballot.named[{family.effect, family.where}] += p;
      continue;
    }
    ballot.unknown += p;
    const bool first = ballot.best_unknown < 0;
    if (first || pick.log_posterior[k] > pick.log_posterior[ballot.best_unknown]) ballot.best_unknown = k;
  }
  return ballot;
}

std::vector<Share> Winners(const Ballot& ballot) {
  std::vector<Share> ranked = Ranked(ballot);
  if (ranked.empty() || ranked.front().second < kNamedFrom) return SmallestSet(ranked, ballot.unknown);
  return {ranked.front()};
}

}  // namespace twinbench::diagnose
