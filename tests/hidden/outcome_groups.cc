#include "tests/hidden/outcome_groups.h"

#include <algorithm>
#include <iterator>

namespace twinbench::hidden {

Outcomes Only(const Outcomes& outcomes, const Condition& condition) {
  Outcomes kept;
  std::ranges::copy_if(outcomes, std::back_inserter(kept), [&](const Outcome* o) { return condition(*o); });
  return kept;
}

Groups By(const Outcomes& outcomes, const Key& key) {
  Groups groups;
  for (const Outcome* o : outcomes) groups[key(*o)].push_back(o);
  return groups;
}

int Count(const Outcomes& outcomes, const Condition& condition) {
  return static_cast<int>(std::ranges::count_if(outcomes, [&](const Outcome* o) { return condition(*o); }));
}

Share ShareOf(const Outcomes& outcomes, const Condition& condition) {
  return {Count(outcomes, condition), static_cast<int>(outcomes.size())};
}

std::vector<double> Values(const Outcomes& outcomes, const std::function<double(const Outcome&)>& value) {
  std::vector<double> values;
  for (const Outcome* o : outcomes) values.push_back(value(*o));
  return values;
}

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return kNaN;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

Condition Graded(Grade grade) {
  return [grade](const Outcome& o) { return o.grade == grade; };
}

bool IsLeaveOneOut(const Outcome& o) {
  return o.set == "leave-one-out";
}

bool IsListed(const Outcome& o) {
  return !o.hidden.causes.empty() && !o.hidden.invisible && !IsLeaveOneOut(o);
}

bool IsConfidentlyWrong(const Outcome& o) {
  return o.confident_wrong;
}

std::string EffectsOf(const Outcome& o) {
  std::string names;
  for (const Part& part : o.hidden.causes) names += (names.empty() ? "" : " + ") + part.effect;
  return names;
}

}  // namespace twinbench::hidden
