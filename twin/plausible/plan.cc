#include "twin/plausible/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/plausible/channel.h"

namespace twinbench::plausible {
namespace {

constexpr int kOneOf = 10;  // readings that are left out in good faith are fewer
constexpr double kMostTimes = 300.0, kLeastTimes = 0.2;
/// Latched samples may have the time at which they were fetched, many together, which says nothing of how fast they
/// came.
constexpr double kFetchedTogether = 2e-4;

/// Positions from the first to the last of the longest pass of the full circle.
int LongestPass(const std::vector<Reading>& readings) {
  std::map<std::pair<int, int>, std::pair<int, int>> passes;
  int longest = 0;
  for (const Reading& r : readings) {
    if (r.phase != Phase::kFullCircle) continue;
    auto& [first, last] = passes.try_emplace({r.setup, r.pass}, r.position, r.position).first->second;
    first = std::min(first, r.position), last = std::max(last, r.position);
    longest = std::max(longest, last - first + 1);
  }
  return longest;
}

void CheckCount(const std::vector<Reading>& readings, const Plan& plan, std::vector<Finding>& findings) {
  const int absent = plan.readings - static_cast<int>(readings.size());
  const bool is_of_plan = std::abs(LongestPass(readings) - plan.positions) <= 1;  // the last may be missing
  if (absent == 0 || !is_of_plan) return;
  findings.push_back(
      {absent > plan.readings / kOneOf,
       fmt::format(
           "there are {} of the {} readings that the scenario plans{}", readings.size(), plan.readings,
           absent < 0
               ? ": is it the scenario of these readings?"
               : ": a run that was interrupted goes on by `measure ... --resume`; if no more were to be taken, say in "
                 "the scenario's procedure which; else somebody may have taken bad ones out")});
}

/// By how much the readings of a pass follow each other slower than planned: the middle of them.
double Slower(const std::vector<Reading>& readings, const Plan& plan, double Interval::*planned_s) {
  std::vector<double> times;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    const Reading &before = readings[i - 1], &here = readings[i];
    if (before.phase != here.phase || before.setup != here.setup || before.pass != here.pass) continue;
    const double should_s = plan.interval(before, here).*planned_s;
    const double slower = ToSeconds(here.time - before.time) / should_s;
    if (should_s > 0.0 && (planned_s == &Interval::usual_s || slower > kFetchedTogether)) times.push_back(slower);
  }
  return times.size() < kFewestToJudge ? 1.0 : MiddleOf(std::move(times));
}

void CheckIntervals(const std::vector<Reading>& readings, const Plan& plan, std::vector<Finding>& findings) {
  const bool has_clock = !readings.empty() && readings.front().time < readings.back().time;
  if (!plan.interval || !has_clock) return;
  const double least = Slower(readings, plan, &Interval::least_s),
               usual = Slower(readings, plan, &Interval::usual_s);
  if (least >= kLeastTimes && usual <= kMostTimes) return;
  findings.push_back(
      {true,
       fmt::format("the readings of a pass follow each other {:.3g} times as slowly as the scenario plans: is "
                   "time_s in s?",
                   usual > kMostTimes ? usual : least)});
}

}  // namespace

void CheckPlan(const std::vector<Reading>& readings, const Plan& plan, std::vector<Finding>& findings) {
  if (plan.readings > 0) CheckCount(readings, plan, findings);
  CheckIntervals(readings, plan, findings);
}

}  // namespace twinbench::plausible
