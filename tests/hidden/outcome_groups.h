#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/hidden/judge.h"
#include "tests/hidden/share.h"

/// Outcomes picked out, counted and put into groups.
namespace twinbench::hidden {

using Outcomes = std::vector<const Outcome*>;
using Groups = std::map<std::string, Outcomes>;
using Condition = std::function<bool(const Outcome&)>;
using Key = std::function<std::string(const Outcome&)>;

Outcomes Only(const Outcomes& outcomes, const Condition& condition);
Groups By(const Outcomes& outcomes, const Key& key);

int Count(const Outcomes& outcomes, const Condition& condition);
Share ShareOf(const Outcomes& outcomes, const Condition& condition);

/// One value of each, in their order.
std::vector<double> Values(const Outcomes& outcomes, const std::function<double(const Outcome&)>& value);

/// The value that `share` of them do not exceed, without interpolation; NaN of none.
double Quantile(std::vector<double> values, double share);

Condition Graded(Grade grade);
bool IsLeaveOneOut(const Outcome& o);
/// Something of the catalogue is hidden, to be seen, and not excluded from it.
bool IsListed(const Outcome& o);
bool IsConfidentlyWrong(const Outcome& o);

/// "tone", of a pair "tone + slip".
std::string EffectsOf(const Outcome& o);

}  // namespace twinbench::hidden
