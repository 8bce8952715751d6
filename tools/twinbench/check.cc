#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/passing_run.h"
#include "tools/twinbench/planned_run.h"
#include "tools/twinbench/progress.h"
#include "tools/twinbench/real_bench.h"
#include "tools/twinbench/run_folder.h"
#include "twin/benches/evaluated.h"
#include "twin/benches/expected.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/estimator.h"
#include "twin/core/reading_clock.h"
#include "twin/core/run_record.h"
#include "twin/report/plan_text.h"
#include "twin/report/sound.h"

namespace twinbench::tools {
namespace {

struct CheckOptions {
  std::string scenario;
  std::vector<std::string> overrides;
};

/// Readings of one phase that end without numbers, for one reason.
struct Lost {
  Phase phase;
  ReadingStatus why;
  std::ptrdiff_t readings, of;
};

/// What the run would give; nothing but why, where its readings come to nothing.
struct Expected {
  std::optional<plan::Outlook> outlook = {};
  std::string why_not = {};
  std::vector<Lost> lost = {};
  std::string not_separated = {};
};

std::vector<Lost> LostOf(const std::vector<Reading>& readings) {
  std::map<std::pair<Phase, ReadingStatus>, std::ptrdiff_t> counts;
  for (const Reading& r : readings)
    if (r.status != ReadingStatus::kOk) ++counts[{r.phase, r.status}];
  std::vector<Lost> lost;
  for (const auto& [what, count] : counts)
    lost.push_back({what.first, what.second, count, std::ranges::count(readings, what.first, &Reading::phase)});
  return lost;
}

/// @param readings  Of the twin, judged as those of the run will be.
/// @throws InputError if the run would be refused.
Expected ExpectedOfReadings(const Scenario& scenario, const std::vector<Reading>& readings) {
  plausible::RefuseFatal(DoubtsAbout(readings, scenario), "its run");
  const auto is_usable = [](const Reading& r) { return r.status == ReadingStatus::kOk; };
  if (std::ranges::none_of(readings, is_usable)) return {.why_not = fmt::format("none of its {} readings would have numbers", readings.size())};
  const report::Evaluation evaluation = EvaluationOf(scenario, readings, Estimator::kRigorous);
  if (evaluation.IsRefuted()) return {.why_not = evaluation.not_separated};
  return {.outlook = plan::OutlookOf(evaluation.results, static_cast<int>(readings.size()), ToSeconds(readings.back().time)),
          .not_separated = evaluation.Separated() ? "" : evaluation.not_separated};
}

/// The scenario of a recording that nobody timed states a procedure all the same; its minutes are nobody's.
bool IsOfRunWithoutClock(const std::string& scenario) {
  const std::filesystem::path path(scenario);
  const RunFolder folder{path.has_parent_path() ? path.parent_path().string() : "."};
  if (path.filename() != kScenarioFile || !std::filesystem::exists(folder.record())) return false;
  return !HasClock(RunRecord::Open(folder.path)->Readings());
}

Expected ExpectedOf(const std::string& path, const Scenario& scenario) {
  Doing("the run as the scenario says");
  std::vector<Lost> lost;
  try {
    const Scenario quick = Quick(scenario);
    const std::vector<Reading> readings = ReadingsOfTwin(quick);
    lost = LostOf(readings);
    Expected expected = ExpectedOfReadings(quick, readings);
    if (expected.outlook && IsOfRunWithoutClock(path)) expected.outlook->minutes = kNaN;
    expected.lost = lost;
    return expected;
  } catch (const InputError& refusal) {
    return {.why_not = refusal.what(), .lost = lost};
  } catch (const BenchError& failure) {
    return {.why_not = failure.what(), .lost = lost};
  }
}

nlohmann::json LostJson(const std::vector<Lost>& lost) {
  nlohmann::json json = nlohmann::json::array();
  for (const Lost& l : lost)
    json.push_back({{"phase", PhaseName(l.phase)}, {"status", ReadingStatusName(l.why)}, {"readings", l.readings}, {"of", l.of}});
  return json;
}

std::string LostText(const std::vector<Lost>& lost) {
  std::string text;
  for (const Lost& l : lost)
    text += fmt::format("It would lose {} of {} readings ({}): {}\n", l.readings, l.of, PhaseName(l.phase), ReadingStatusName(l.why));
  return text;
}

nlohmann::json JsonOf(const CheckOptions& options, const Scenario& scenario, int readings, const Expected& expected,
                      const std::optional<double>& on_real_bench) {
  nlohmann::json json = {{"scenario", options.scenario},
                         {"bench", scenario.bench},
                         {"title", scenario.title},
                         {"readings", readings},
                         {"effects", scenario.effects.size()},
                         {"stated_uncertainties", scenario.uncertainties.size()}};
  if (expected.outlook)
    json["expected"] = report::OutlookJson({"as the scenario says", {}, *expected.outlook});
  else
    json["no_results"] = expected.why_not;
  if (!expected.lost.empty()) json["lost_readings"] = LostJson(expected.lost);
  if (!expected.not_separated.empty()) json["not_separated"] = expected.not_separated;
  if (on_real_bench) json["real_bench_minutes"] = *on_real_bench;
  return json;
}

std::string Counted(std::size_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string DurationOf(double minutes, const std::optional<double>& on_real_bench) {
  if (std::isnan(minutes)) return "how long it takes is not known: the recording beside it has no clock";
  return fmt::format("{} minutes by the procedure's clock{}", report::MinutesText(minutes), WithProofs(minutes, on_real_bench));
}

/// Loading is the check: whatever is wrong is told with its line. The twin is built as well, for a scenario may
/// name parts that do not go together.
void Check(const CheckOptions& options, JsonAnswer& answer) {
  RequireOutput(answer.to(), {options.scenario});
  const Scenario scenario = LoadScenario(options.scenario, options.overrides);
  const Bench& bench = BenchOf(scenario);
  static_cast<void>(bench.make_twin(scenario));
  const int readings = bench.planned_readings(scenario);
  // Two runs of twins that do not need each other.
  auto minutes = std::async(std::launch::async, [&scenario] { return MinutesOnRealBench(scenario); });
  const Expected expected = ExpectedOf(options.scenario, scenario);
  const std::optional<double> on_real_bench = minutes.get();
  answer.Write(JsonOf(options, scenario, readings, expected, on_real_bench));
  if (answer.IsOnStdout()) return;
  const bool is_fine = expected.outlook && expected.not_separated.empty();
  fmt::print("{}: {}. Bench {}, {}, {}, {} with a stated uncertainty\n", options.scenario, is_fine ? "fine" : "every key is right, its run is not", scenario.bench,
             Counted(static_cast<std::size_t>(readings), "reading"), Counted(scenario.effects.size(), "effect"),
             Counted(scenario.uncertainties.size(), "constant"));
  fmt::print("{}", LostText(expected.lost));
  if (!expected.not_separated.empty()) fmt::print("It would separate nothing: {}\n", expected.not_separated);
  if (!expected.outlook) return fmt::print("It would come to no result: {}\n", expected.why_not);
  fmt::print("{}\n\n{}", DurationOf(expected.outlook->minutes, on_real_bench),
             report::WithoutNoNumbers(report::OutlookText(*expected.outlook)));
}

}  // namespace

void AddCheck(CLI::App& app) {
  auto* command = app.add_subcommand(
      "check",
      "Say whether a scenario can be simulated, how long it takes, which u to expect and what is not separable");
  auto options = std::make_shared<CheckOptions>();
  command->add_option("scenario", options->scenario, "scenario file (TOML)")->required();
  AddSet(*command, options->overrides);
  AnswerWith(*command, "what was found", [options](JsonAnswer& answer) { Check(*options, answer); });
}

}  // namespace twinbench::tools
