#include "twin/diagnose/cause_groups.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace twinbench::diagnose {
namespace {

const Rival* RivalryOf(const Cause& cause, const Cause& other) {
  for (const Rival& rival : cause.indistinguishable_from) {
    if (rival.effect == other.effect && rival.where == other.where) return &rival;
  }
  return nullptr;
}

/// Only one of a group is there: together they are no more probable than that.
bool ExcludesAll(const std::vector<Cause>& causes, const CauseGroup& group, const Cause& other) {
  constexpr double kRounding = 1e-6;
  double sum = other.probability;
  for (const std::size_t k : group) sum += causes[k].probability;
  return !(sum > 1.0 + kRounding);
}

}  // namespace

std::vector<CauseGroup> GroupsOf(const std::vector<Cause>& causes) {
  std::vector<CauseGroup> groups;
  for (std::size_t k = 0; k < causes.size(); ++k) {
    const auto its = std::ranges::find_if(groups, [&](const CauseGroup& group) {
      return RivalryOf(causes[group.front()], causes[k]) != nullptr && ExcludesAll(causes, group, causes[k]);
    });
    if (its == groups.end())
      groups.push_back({k});
    else
      its->push_back(k);
  }
  return groups;
}

double ShareOf(const CauseGroup& group, const std::vector<double>& share) {
  for (const std::size_t k : group) {
    if (k < share.size() && std::isfinite(share[k])) return share[k];
  }
  return kNaN;
}

std::vector<CauseGroup> GroupsByShare(const std::vector<Cause>& causes, const std::vector<double>& share) {
  std::vector<CauseGroup> groups = GroupsOf(causes);
  const auto rank = [&share](const CauseGroup& group) {
    const double own = ShareOf(group, share);
    return std::isfinite(own) ? own : -std::numeric_limits<double>::infinity();
  };
  std::ranges::stable_sort(groups, std::ranges::greater{}, rank);
  return groups;
}

double Imitates(const std::vector<Cause>& causes, const CauseGroup& group, std::size_t member) {
  const Rival* const rival = RivalryOf(causes[group.front()], causes[group[member]]);
  return rival ? rival->overlap : kNaN;
}

}  // namespace twinbench::diagnose
