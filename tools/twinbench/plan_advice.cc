#include "tools/twinbench/plan_advice.h"

#include <fmt/format.h>

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
#include "twin/plan/mended.h"
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

/// Of what is not shared by all runs: for each kind of results what the other run adds, in units of 1 / u^2 of the own.
Eigen::VectorXd PrecisionOf(const LookedAt& own, const LookedAt& other, const std::string& goal) {
  const std::vector<plan::Gain> all = plan::GainsOf(own.results, own.results, goal);
  const std::vector<plan::Gain> gains = plan::GainsOf(own.results, other.results, goal);
  Eigen::VectorXd precision = Eigen::VectorXd::Zero(std::ssize(all));
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto gain = std::ranges::find(gains, all[k].name, &plan::Gain::name);
    if (gain != gains.end()) precision[static_cast<Eigen::Index>(k)] = gain->precision;
  }
  return precision;
}

/// Before any other run; 1 of what all runs share alone, so that there is no kind without.
Eigen::VectorXd PrecisionBefore(const LookedAt& own, const std::string& goal) {
  const std::vector<plan::Gain> all = plan::GainsOf(own.results, own.results, goal);
  Eigen::VectorXd precision(std::ssize(all));
  std::ranges::transform(all, precision.begin(), [](const plan::Gain& gain) { return gain.precision_before > 0.0 ? gain.precision_before : 1.0; });
  return precision;
}

/// Causes in their plausible sizes, and behind them kinds of results.
/// @param causes  So many; 0: results alone.
Eigen::MatrixXd JointInformation(const LookedAt& own, const LookedAt& other, const std::string& goal, Eigen::Index causes) {
  const Eigen::VectorXd precision = PrecisionOf(own, other, goal);
  Eigen::MatrixXd joint = Eigen::MatrixXd::Zero(causes + precision.size(), causes + precision.size());
  if (causes > 0 && other.isolability)
    joint.topLeftCorner(causes, causes) = diagnose::InformationInOrder(*other.isolability, *own.isolability);
  joint.bottomRightCorner(precision.size(), precision.size()) = precision.asDiagonal();
  return joint;
}

/// Of the own run, and what is thought of the causes' sizes before.
Eigen::MatrixXd KnownBefore(const LookedAt& own, const std::string& goal, Eigen::Index causes) {
  Eigen::MatrixXd known = JointInformation(own, own, goal, causes);
  known.diagonal().head(causes).array() += 1.0;
  const Eigen::VectorXd of_results = PrecisionBefore(own, goal);
  known.diagonal().tail(of_results.size()) = of_results;
  return known;
}

constexpr const char* kWantOfTime = "not computed: --cpu";
constexpr const char* kNoCauses = "-";  // in the own run, to be compared with

plan::Advice AdviceOf(const LookedAt& own, const LookedAt& other, const std::string& goal) {
  plan::Advice advice;
  advice.run = other.run;
  advice.readings = other.planned.outlook.readings;
  advice.minutes = other.planned.outlook.minutes;
  advice.gains = plan::GainsOf(own.results, other.results, goal);
  advice.of_results_bit = plan::MeanGain_bit(advice.gains);
  advice.mended = plan::MendedInWords(own.planned.outlook, other.planned.outlook);
  advice.closest = kNaN;
  if (!own.isolability || !other.is_looked_at_for_causes) advice.causes_unknown = own.isolability ? kWantOfTime : kNoCauses;
  if (!advice.causes_unknown.empty() || !other.isolability) return advice;
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
  own.is_looked_at_for_causes = true;
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
    other.is_looked_at_for_causes = true;
  }
}

std::vector<report::Mending> Mendings(const Scenario& scenario, const LookedAt& own, Patience& patience) {
  const std::optional<plan::ShiftDesign> design = ShiftDesignOf(scenario);
  if (!design) return {};
  constexpr double kOfMendings = 0.75;
  const auto results_of = [&](const plan::NextRun& run) { return LookAtResults(run, scenario); };
  const std::vector<LookedAt> good = EachThatCanBe({GoodRun(*design)}, "the run at a good set of shifts", kOfMendings, patience, results_of);
  if (good.empty() || plan::MendedBy(own.planned.outlook, good.front().planned.outlook).empty()) return {};
  std::vector<report::Mending> mendings;
  const auto looked = EachThatCanBe(Additions(*design), "an addition that may separate what is lost", kOfMendings, patience, results_of);
  for (const LookedAt& other : looked) {
    report::Mending mending;
    mending.run = other.run;
    mending.minutes = other.planned.outlook.minutes;
    mending.more_minutes = mending.minutes - own.planned.outlook.minutes;
    mending.dof = other.planned.outlook.dof;
    mending.mended = plan::WhollyMendedBy(own.planned.outlook, other.planned.outlook, good.front().planned.outlook);
    mending.words = plan::MendedInWords(own.planned.outlook, other.planned.outlook);
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
  programme.runs.push_back(AdviceOf(own, own, goal));
  for (const LookedAt& other : others) programme.runs.push_back(AdviceOf(own, other, goal));
  programme.is_of_results_alone = !std::ranges::all_of(programme.runs, &plan::Advice::IsWhole);
  const Eigen::Index causes = programme.is_of_results_alone ? 0 : std::ssize(own.isolability->causes);
  std::vector<plan::RunInformation> runs;
  const auto add = [&](const LookedAt& looked) {
    const plan::Advice& advice = programme.runs[runs.size()];
    runs.push_back({budget.in_readings ? advice.readings : advice.minutes, JointInformation(own, looked, goal, causes)});
  };
  add(own);
  for (const LookedAt& other : others) add(other);
  const Eigen::MatrixXd known = KnownBefore(own, goal, causes);
  programme.unknowns = static_cast<int>(known.rows());
  programme.best = plan::BestProgramme(known, runs, budget.amount, plan::Optimality::kD);
  programme.least_trace = plan::BestProgramme(known, runs, budget.amount, plan::Optimality::kA);
  std::vector<const nlohmann::json*> made(static_cast<std::size_t>(programme.best.times.front()), &own.results);
  for (std::size_t k = 0; k < others.size(); ++k) made.insert(made.end(), static_cast<std::size_t>(programme.best.times[k + 1]), &others[k].results);
  programme.gains = plan::GainsOf(own.results, made, "");
  return programme;
}

}  // namespace twinbench::tools
