#include "tools/twinbench/plan_advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "tools/twinbench/passing_run.h"
#include "tools/twinbench/progress.h"
#include "twin/benches/evaluated.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/estimator.h"
#include "twin/diagnose/isolability.h"
#include "twin/diagnose/joint_design.h"
#include "twin/report/evaluation.h"
#include "twin/uncertainty/quantities.h"

namespace twinbench::tools {
namespace {

nlohmann::json EvaluatedBy(const Scenario& scenario, const std::vector<Reading>& readings) {
  return EvaluationOf(scenario, readings, Estimator::kRigorous).results;
}

std::shared_ptr<const diagnose::Isolability> ShownBy(const Scenario& scenario,
                                                     const std::vector<Reading>& readings) {
  try {
    return SeenBy(scenario, readings).isolability;
  } catch (const InputError&) {  // too few readings to tell a cause by
    return nullptr;
  }
}

/// Results alone; an evaluation that refuses the readings leaves them empty.
LookedAt ResultsOfRun(const plan::NextRun& run, const Scenario& scenario, const std::vector<Reading>& readings) {
  LookedAt looked;
  looked.run = run;
  try {
    looked.results = EvaluatedBy(scenario, readings);
  } catch (const InputError&) {  // tells of causes only
    looked.results = nlohmann::json::object();
  }
  const double last_s = readings.empty() ? 0.0 : ToSeconds(readings.back().time);
  looked.planned = {run.words, {}, plan::OutlookOf(looked.results, static_cast<int>(readings.size()), last_s)};
  return looked;
}

/// The same of a run of the quick twin.
LookedAt LookAtResults(const plan::NextRun& run, const Scenario& scenario) {
  const Scenario quick = Quick(Altered(scenario, run.sets));
  return ResultsOfRun(run, quick, ReadingsOfTwin(quick));
}

plan::NextRun WithShifts(const std::string& name, const plan::ShiftDesign& design, std::vector<int> shifts) {
  return {name, design.words + " " + report::ShiftList(shifts), design.sets(shifts), plan::kSameKind};
}

std::vector<plan::NextRun> ShiftRuns(const plan::ShiftDesign& design, int setups) {
  std::vector<plan::NextRun> runs = {WithShifts(kBestShifts, design, plan::BestShifts(design.positions, setups).shifts)};
  if (setups < design.positions)
    runs.push_back(WithShifts("one-more-shift", design, plan::WithOneMore(design.positions, design.shifts).shifts));
  return runs;
}

/// Third shifts and the like, spread over the circle where there are too many to try all.
std::vector<plan::NextRun> Additions(const plan::ShiftDesign& design) {
  constexpr int kMostTried = 40, kMostTriedOfMany = 12, kMany = 72;
  const int n = design.positions, most = n > kMany ? kMostTriedOfMany : kMostTried;
  std::vector<plan::NextRun> runs = design.other_ways;
  std::vector<int> tried;
  for (int k = 0; k < most; ++k) {
    const int s = std::max(1, k * n / most);
    if (std::ranges::count(design.shifts, s) > 0 || std::ranges::count(tried, s) > 0) continue;
    tried.push_back(s);
    std::vector<int> more = design.shifts;
    more.push_back(s);
    runs.push_back(WithShifts(fmt::format("shift-{}", s), design, more));
  }
  return runs;
}

std::vector<std::string> Without(const std::vector<std::string>& all, const std::vector<std::string>& others) {
  std::vector<std::string> left;
  for (const std::string& one : all) {
    if (std::ranges::count(others, one) == 0) left.push_back(one);
  }
  return left;
}

/// What the own run loses and the other one does not.
std::vector<std::string> MendedBy(const LookedAt& own, const LookedAt& other) {
  if (!other.planned.outlook.separates) return {};
  return Without(own.planned.outlook.lost, other.planned.outlook.lost);
}

/// "reference dx,dy orders +2, -4" is a part of "reference dy": the same words, components separated by commas.
bool IsPartOf(const std::string& part, const std::string& what) {
  if (part.starts_with(what)) return true;
  const std::size_t space = what.find(' ');
  if (space == std::string::npos || !part.starts_with(what.substr(0, space + 1))) return false;
  const std::string component = what.substr(space + 1);
  const std::string components = "," + part.substr(space + 1, part.find(' ', space + 1) - space - 1) + ",";
  return components.find("," + component + ",") != std::string::npos;
}

/// The same in words; what comes back in parts only names those.
std::vector<std::string> MendedInWords(const LookedAt& own, const LookedAt& other) {
  std::vector<std::string> words;
  for (const std::string& what : MendedBy(own, other)) {
    std::vector<std::string> stays;
    bool is_lost = false;
    for (const std::string& part : other.planned.outlook.lost) {
      is_lost = is_lost || IsPartOf(what, part);
      if (IsPartOf(part, what)) stays.push_back(part);
    }
    if (is_lost) continue;  // as a part of more
    words.push_back(stays.empty() ? what : fmt::format("{} but for {}", what, fmt::join(stays, "; ")));
  }
  return words;
}

/// Of that, what the other one loses no part of but those that a good set of shifts loses too: "target dy" is not mended
/// where "target dy orders 2, 4" stays.
std::vector<std::string> WhollyMendedBy(const LookedAt& own, const LookedAt& other, const LookedAt& good) {
  std::vector<std::string> mended = MendedBy(own, other);
  const std::vector<std::string> stays = Without(other.planned.outlook.lost, good.planned.outlook.lost);
  std::erase_if(mended, [&stays](const std::string& what) {
    return std::ranges::any_of(stays, [&what](const std::string& part) { return IsPartOf(part, what); });
  });
  return mended;
}

/// Curves that only the other one determines, with their uncertainty.
std::vector<plan::Gain> AddedBy(const LookedAt& own, const LookedAt& other) {
  std::vector<plan::Gain> added;
  const auto& had = own.planned.outlook.results;
  for (const plan::Certainty& result : other.planned.outlook.results) {
    if (std::ranges::count(had, result.name, &plan::Certainty::name) == 0)
      added.push_back({result.name, result.rms_u});
  }
  return added;
}

/// The run at a good set of shifts: what it does not separate no shifts do.
plan::NextRun GoodRun(const plan::ShiftDesign& design) {
  constexpr int kGoodSetups = 4;
  const int setups = std::min(kGoodSetups, design.positions);
  return WithShifts("good", design, plan::BestShifts(design.positions, setups).shifts);
}

/// How well the added results are known together; nothing added comes last.
double MeanU(const report::Mending& mending) {
  if (mending.certain.empty()) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const plan::Gain& result : mending.certain) sum += std::log(result.ratio);
  return std::exp(sum / static_cast<double>(mending.certain.size()));
}

/// A scalar of precision for each kind of results, in units of the own run's.
Eigen::VectorXd PrecisionOf(const LookedAt& own, const LookedAt& other, const std::string& goal) {
  const std::vector<plan::Gain> all = plan::GainsOf(own.results, own.results, goal);
  const std::vector<plan::Gain> gains = plan::GainsOf(own.results, other.results, goal);
  Eigen::VectorXd precision = Eigen::VectorXd::Zero(std::ssize(all));
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto gain = std::ranges::find(gains, all[k].name, &plan::Gain::name);
    if (gain != gains.end()) precision[static_cast<Eigen::Index>(k)] = 1.0 / (gain->ratio * gain->ratio) - 1.0;
  }
  return precision;
}

/// Causes in their plausible sizes, and behind them kinds of results.
Eigen::MatrixXd JointInformation(const LookedAt& own, const LookedAt& other, const std::string& goal) {
  const Eigen::VectorXd precision = PrecisionOf(own, other, goal);
  const Eigen::Index causes = own.isolability ? std::ssize(own.isolability->causes) : 0;
  Eigen::MatrixXd joint = Eigen::MatrixXd::Zero(causes + precision.size(), causes + precision.size());
  if (own.isolability && other.isolability)
    joint.topLeftCorner(causes, causes) = diagnose::InformationInOrder(*other.isolability, *own.isolability);
  joint.bottomRightCorner(precision.size(), precision.size()) = precision.asDiagonal();
  return joint;
}

plan::Advice AdviceOf(const LookedAt& own, const LookedAt& other, const std::string& goal) {
  plan::Advice advice;
  advice.run = other.run;
  advice.readings = other.planned.outlook.readings;
  advice.minutes = other.planned.outlook.minutes;
  advice.gains = plan::GainsOf(own.results, other.results, goal);
  advice.of_results_bit = plan::MeanGain_bit(advice.gains);
  advice.mended = MendedInWords(own, other);
  advice.closest = kNaN;
  if (!own.isolability || !other.isolability) return advice;
  advice.broken = diagnose::BrokenTies(*own.isolability, *other.isolability);
  advice.shown = diagnose::NewlyShown(*own.isolability, *other.isolability);
  const Eigen::MatrixXd before = own.isolability->information;
  const Eigen::MatrixXd both = before + diagnose::InformationInOrder(*other.isolability, *own.isolability);
  advice.of_causes_bit = diagnose::InformationGain_bit(both) - diagnose::InformationGain_bit(before);
  advice.closest = diagnose::ClosestCauses(both);
  return advice;
}

plan::NextRun OnceMore() {
  return {"again", "the same run once more", {}, plan::kSameKind};
}

/// Each run as `look` sees it, until that share of the patience is gone; what bench, twin or evaluation refuse is left out.
template <class Look>
std::vector<LookedAt> EachThatCanBe(const std::vector<plan::NextRun>& runs, const std::string& what, double share, Patience& patience,
                                    const Look& look) {
  std::vector<LookedAt> looked;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (!patience.Allows(share, what)) continue;
    Doing(fmt::format("{} {} of {}: {}", what, k + 1, runs.size(), runs[k].words));
    try {
      looked.push_back(look(runs[k]));
    } catch (const InputError&) {  // not on this bench as it stands
    } catch (const BenchError&) {
    }
  }
  return looked;
}

}  // namespace

std::optional<plan::ShiftDesign> ShiftDesignOf(const Scenario& scenario) {
  const Bench& bench = BenchOf(scenario);
  if (!bench.shift_design) return std::nullopt;
  plan::ShiftDesign design = bench.shift_design(scenario);
  return design.positions > 0 ? std::optional(std::move(design)) : std::nullopt;
}

LookedAt LookAtOwn(const Scenario& scenario) {
  LookedAt own = ResultsOfOwn(scenario);
  const Scenario quick = Quick(scenario);
  own.isolability = ShownBy(quick, ReadingsOfTwin(quick));
  return own;
}

LookedAt ResultsOfOwn(const Scenario& scenario) {
  return LookAtResults(OnceMore(), scenario);
}

std::vector<LookedAt> LookAtOthers(const Scenario& scenario, int setups, double share, Patience& patience) {
  const Bench& bench = BenchOf(scenario);
  std::vector<plan::NextRun> runs;
  if (const auto design = ShiftDesignOf(scenario)) {
    runs = ShiftRuns(*design, setups);
    runs.insert(runs.end(), design->other_ways.begin(), design->other_ways.end());
  }
  if (bench.next_runs) {
    for (plan::NextRun& run : bench.next_runs(scenario)) runs.push_back(std::move(run));
  }
  return EachThatCanBe(runs, "another run", share, patience, [&](const plan::NextRun& run) { return LookAtResults(run, scenario); });
}

void LookAtCauses(const Scenario& scenario, Patience& patience, std::vector<LookedAt>& others) {
  for (LookedAt& other : others) {
    if (!patience.Allows(1.0, kTellingOfCauses)) continue;
    Doing("what another run would tell of causes: " + other.run.words);
    const Scenario quick = Quick(Altered(scenario, other.run.sets));
    other.isolability = ShownBy(quick, ReadingsOfTwin(quick));
  }
}

std::vector<report::Mending> Mendings(const Scenario& scenario, const LookedAt& own, Patience& patience) {
  const std::optional<plan::ShiftDesign> design = ShiftDesignOf(scenario);
  if (!design) return {};
  constexpr double kOfMendings = 0.75;
  const auto results_of = [&](const plan::NextRun& run) { return LookAtResults(run, scenario); };
  const std::vector<LookedAt> good = EachThatCanBe({GoodRun(*design)}, "the run at a good set of shifts", kOfMendings, patience, results_of);
  if (good.empty() || MendedBy(own, good.front()).empty()) return {};
  std::vector<report::Mending> mendings;
  const auto looked = EachThatCanBe(Additions(*design), "an addition that may separate what is lost", kOfMendings, patience, results_of);
  for (const LookedAt& other : looked) {
    report::Mending mending;
    mending.run = other.run;
    mending.minutes = other.planned.outlook.minutes;
    mending.more_minutes = mending.minutes - own.planned.outlook.minutes;
    mending.mended = WhollyMendedBy(own, other, good.front());
    mending.certain = AddedBy(own, other);
    if (!mending.mended.empty()) mendings.push_back(std::move(mending));
  }
  std::ranges::stable_sort(mendings, {}, [](const report::Mending& m) {
    return std::tuple(std::round(m.more_minutes), -std::ssize(m.mended), MeanU(m));
  });
  return mendings;
}

std::vector<plan::Advice> AdviceOf(const LookedAt& own, const std::vector<LookedAt>& others,
                                   const std::string& goal) {
  std::vector<plan::Advice> advice = {AdviceOf(own, own, goal)};
  for (const LookedAt& other : others) advice.push_back(AdviceOf(own, other, goal));
  plan::Rank(advice);
  return advice;
}

report::PlannedProgramme ProgrammeOf(const LookedAt& own, const std::vector<LookedAt>& others,
                                     const report::PlanBudget& budget, const std::string& goal) {
  report::PlannedProgramme programme;
  programme.budget = budget;
  std::vector<plan::RunInformation> runs;
  const auto add = [&](const LookedAt& looked) {
    programme.runs.push_back(AdviceOf(own, looked, goal));
    const plan::Advice& advice = programme.runs.back();
    runs.push_back({budget.in_readings ? advice.readings : advice.minutes, JointInformation(own, looked, goal)});
  };
  add(own);
  for (const LookedAt& other : others) add(other);
  Eigen::MatrixXd known = runs.front().information;
  const Eigen::Index causes = own.isolability ? std::ssize(own.isolability->causes) : 0;
  known.diagonal().head(causes).array() += 1.0;  // what is thought of their sizes before
  programme.unknowns = static_cast<int>(known.rows());
  programme.best = plan::BestProgramme(known, runs, budget.amount, plan::Optimality::kD);
  programme.least_trace = plan::BestProgramme(known, runs, budget.amount, plan::Optimality::kA);
  std::vector<const nlohmann::json*> made(static_cast<std::size_t>(programme.best.times.front()), &own.results);
  for (std::size_t k = 0; k < others.size(); ++k) made.insert(made.end(), static_cast<std::size_t>(programme.best.times[k + 1]), &others[k].results);
  programme.gains = plan::GainsOf(own.results, made, goal);
  return programme;
}

}  // namespace twinbench::tools
