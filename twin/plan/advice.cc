#include "twin/plan/advice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "twin/uncertainty/every_run.h"
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

/// One number as several runs give it: their mean by what each has anew is as certain as that, and by what they share as certain as the
/// mean of it.
class Together {
 public:
  void Add(const uncertainty::Quantity& q) {
    const double variance = q.u * q.u, own = uncertainty::OwnShare(q) * variance;
    best_ = std::min(best_, variance);
    if (!(own > 0.0)) return;
    precision_ += 1.0 / own;
    shared_ += std::sqrt(variance - own) / own;
  }
  /// Never more than that of the best of them.
  double Variance() const {
    if (precision_ == 0.0) return best_;
    const double shared = shared_ / precision_;
    return std::min(best_, 1.0 / precision_ + shared * shared);
  }
  double OwnVariance() const { return precision_ > 0.0 ? 1.0 / precision_ : 0.0; }

 private:
  double best_ = std::numeric_limits<double>::infinity();
  double precision_ = 0.0, shared_ = 0.0;
};

struct OfKind {
  double before = 0.0, after = 0.0;          // variances
  double own_before = 0.0, own_after = 0.0;  // of what is not shared
  bool in_both = false;

  void Add(const Together& first, const Together& all) {
    before += first.Variance();
    after += all.Variance();
    own_before += first.OwnVariance();
    own_after += all.OwnVariance();
  }
  Gain As(const std::string& name) const {
    Gain gain{name, std::sqrt(after / before)};
    if (!(own_before > 0.0)) return gain;
    gain.precision_before = before / own_before;
    gain.precision = before / own_after - gain.precision_before;
    return gain;
  }
};

}  // namespace

std::vector<Gain> GainsOf(const nlohmann::json& before, const std::vector<const nlohmann::json*>& more, const std::string& wanted) {
  std::multimap<std::string, uncertainty::Quantity> of_more;
  for (const nlohmann::json* run : more)
    for (uncertainty::Quantity& q : uncertainty::QuantitiesOf(*run))
      if (q.u > 0.0) of_more.emplace(q.name, std::move(q));
  std::map<std::string, OfKind> kinds;
  for (const uncertainty::Quantity& q : uncertainty::QuantitiesOf(before)) {
    const std::string kind = uncertainty::KindOf(q.name);
    if (!(q.u > 0.0) || !uncertainty::OutlastsTheRun(q.name) || !IsWanted(kind, wanted)) continue;
    Together first;
    first.Add(q);
    Together all = first;
    const auto [from, to] = of_more.equal_range(q.name);
    for (auto other = from; other != to; ++other) all.Add(other->second);
    kinds[kind].Add(first, all);
    kinds[kind].in_both = kinds[kind].in_both || from != to;
  }
  std::vector<Gain> gains;
  for (const auto& [name, kind] : kinds) {
    if (kind.in_both) gains.push_back(kind.As(name));
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

double RateOf(const Advice& one, const std::vector<Advice>& among) {
  const bool all_whole = std::ranges::all_of(among, &Advice::IsWhole);
  const double bought_bit = all_whole ? one.Bought_bit() : one.BoughtOfResults_bit();
  return one.minutes > 0.0 ? bought_bit / one.minutes : 0.0;
}

void Rank(std::vector<Advice>& advice) {
  const std::vector<Advice> among = advice;
  std::ranges::stable_sort(advice, std::ranges::greater{}, [&among](const Advice& one) { return RateOf(one, among); });
}

}  // namespace twinbench::plan
