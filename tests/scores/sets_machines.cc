#include "tests/foreign/plans.h"
#include "tests/investigate/hidden_investigation.h"
#include "tests/own_scenario/own_scenario.h"
#include "tests/scores/sets.h"
#include "tests/shelf/judge.h"
#include "tests/support/thresholds.h"
#include "tests/support/twin_run.h"
#include "twin/benches/names.h"

// Machines that can be run again (tests/foreign), recordings (tests/data/shelf), the twin against its own scenario, and investigations.
namespace twinbench::scores {
namespace {

// Cases of tests/foreign: machines that can be run again.

/// What a diagnosis with the written file said, where it should have been silent.
std::string Spoken(const std::string& when, const std::optional<std::string>& words) {
  return words && !words->empty() ? "; " + when + ": " + *words : "";
}

void Fill(const foreign::Answer& answer, Row& row) {
  row.hidden = answer.truth.IsClean() ? "none" : answer.truth.kind;
  row.answer = answer.words + Spoken("again", answer.second) + Spoken("another day", answer.second_run);
  row.marks[kRight] = IsRight(answer);
  row.marks[kSureWrong] = IsSurelyWrong(answer);
  if (answer.second) row.marks[kSecondSilent] = answer.second->empty();
  if (answer.second_run) row.marks[kSecondRunSilent] = answer.second_run->empty();
  row.marks[kGainRight] = IsGainRight(answer);
  if (row.marks[kGainRight]) row.answer += fmt::format("; gain {:.3f}, stated {:.3f}", answer.file_gain, answer.stated_gain);
}

/// @param machines  Of any bench: those of the wanted one are taken.
void AppendMachines(const std::string& set, const std::string& bench, const std::string& prefix,
                    const std::vector<foreign::Plan>& machines, Plans& plans) {
  for (const foreign::Plan& machine : machines) {
    if (!machine.set.ends_with(" " + bench)) continue;
    plans.push_back({set, bench, prefix + machine.name, [=](Row& row) { Fill(foreign::Examine(machine), row); }});
  }
}

// Recordings of tests/data/shelf.

void Fill(const shelf::Answer& answer, Row& row) {
  row.hidden = answer.truth;
  row.answer = (answer.judged.why.empty() || answer.judged.why == answer.words ? "" : answer.judged.why + " <- ") +
               answer.words;
  row.marks[kRight] = answer.judged.is_right;
  row.marks[kSureWrong] = answer.judged.is_sure_wrong;
  if (!answer.second) return;
  row.marks[kSecondSilent] = answer.second->empty();
  if (!answer.second->empty()) row.answer += "; again: " + *answer.second;
}

using investigate::Judged;

void Fill(const Judged& judged, Row& row) {
  row.hidden = judged.truth;
  row.answer = fmt::format("{}: {}", ResultName(judged.result), judged.answer);
  row.marks[kRight] = judged.IsRight();
  row.marks[kSureWrong] = judged.result == investigate::Result::kWrong && judged.probability >= hidden::kSure;
}

template <class T>
const T& DrawnFrom(const std::vector<T>& all, Stream& stream) {
  return all[static_cast<std::size_t>(stream.Uniform() * static_cast<double>(all.size()))];
}

const investigate::InvestigationOptions kTenHours = {.goal = {}, .budget_min = 600.0, .faint = {}};

Judged OfTwin(const std::string& bench, std::uint64_t seed) {
  constexpr double kUnlistedShare = 0.2;
  std::vector<hidden::Placement> placements = hidden::Placements(bench);
  // A convention is there or not: no size of it can be drawn, and on some designs free tables take it up.
  std::erase_if(placements, [](const hidden::Placement& at) { return at.effect == "convention"; });
  Stream stream(seed, "investigate.score");
  const hidden::Placement& at = DrawnFrom(placements, stream);
  const double rho = hidden::LogUniformIn(stream, 2.0, 20.0);
  if (stream.Uniform() >= kUnlistedShare)
    return InvestigateHidden(at, seed, rho, hidden::ScaleOf(at.design), kTenHours);
  const std::vector<hidden::Design> designs = hidden::PlainDesigns(bench);
  const hidden::Design design = DrawnFrom(designs, stream);
  const hidden::UnlistedCause& cause = DrawnFrom(hidden::UnlistedCausesOf(bench), stream);
  return InvestigateUnlisted(design, cause, seed, rho, hidden::ScaleOf(design), kTenHours);
}

}  // namespace

Plans ForeignSet(const std::string& bench, const Amount& amount) {
  Plans plans;
  const int times = amount.is_long ? 4 : 1;
  AppendMachines("foreign", bench, "", foreign::KindPlans(times, amount.first_seed), plans);
  AppendMachines("foreign", bench, "", foreign::SeveralPlans(21 * times, amount.first_seed), plans);
  AppendMachines("foreign", bench, "clean ", foreign::CleanPlans(40 * times, amount.first_seed), plans);
  return plans;
}

Plans TwoRunsSet(const std::string& bench, const Amount& amount) {
  Plans plans;
  AppendMachines("two_runs", bench, "", foreign::TwinPlans(bench, amount.is_long ? 32 : 8, amount.first_seed), plans);
  return plans;
}

Plans ShelfSet(const std::string& bench, const Amount&) {
  Plans plans;
  if (bench != kEncoderBench) return plans;
  for (const std::string& name : shelf::CaseNames()) {
    plans.push_back({"shelf", bench, name, [name](Row& row) { Fill(shelf::Examine(name, true), row); }});
  }
  return plans;
}

constexpr std::size_t kTogether = 4;  // names of cases hang on it

Plans OwnScenarioSet(const std::string& bench, const Amount& amount) {
  Plans plans;
  const auto& all = test::OwnBenches();
  const test::OwnBench& own = *std::ranges::find(all, bench, &test::OwnBench::name);
  std::vector<test::OwnRun> runs = test::KeyRuns(own, kTogether);
  for (test::OwnRun& run : test::EffectRuns(own, 1)) {
    run.what = "effect " + run.what;
    runs.push_back(run);
  }
  // The suite runs all of them with the scenario's own seed; here are others.
  for (std::size_t k = 0; k < runs.size(); k += amount.is_long ? 1 : 4) {
    test::OwnRun run = runs[k];
    run.scenario.seed += amount.first_seed;
    plans.push_back({"own_scenario", bench, run.what, [run](Row& row) {
                       row.hidden = "none";
                       row.answer = AlarmOf(run);
                       row.marks[kRight] = row.answer.empty();
                     }});
  }
  return plans;
}

Plans InvestigateSet(const std::string& bench, const Amount& amount) {
  Plans plans;
  if (bench == kFreeformBench && !amount.is_long) return plans;  // minutes each: the standard set is to end in twenty
  const int cases = amount.is_long ? 8 : 2;
  for (int k = 0; k < cases; ++k) {
    const std::uint64_t seed = amount.first_seed + static_cast<std::uint64_t>(k);
    plans.push_back(
        {"investigate", bench, fmt::format("twin {}", seed), [=](Row& row) { Fill(OfTwin(bench, seed), row); }});
    if (bench != kEncoderBench) continue;
    plans.push_back(
        {"investigate", bench, fmt::format("program {}", seed), [=](Row& row) { Fill(investigate::InvestigateProgram(seed), row); }});
  }
  return plans;
}

}  // namespace twinbench::scores
