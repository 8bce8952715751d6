#include <fmt/core.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/evaluated_run.h"
#include "tools/twinbench/measured_bench.h"
#include "tools/twinbench/progress.h"
#include "tools/twinbench/rehearsal.h"
#include "tools/twinbench/run_folder.h"
#include "tools/twinbench/stop_signal.h"
#include "twin/benches/registry.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/core/device_fault.h"
#include "twin/core/run_record.h"

namespace twinbench::tools {
namespace {

struct MeasureOptions {
  std::string scenario, bench, folder;
  std::vector<std::string> overrides;
  bool resume = false, rehearse = false, rehearse_only = false;
};

constexpr double kColdest_degC = -20.0, kHottest_degC = 60.0;  // beyond: no room that a bench stands in

procedure::Options Carefulness(const hw::BenchFile& file) {
  procedure::Options options;
  options.target = file.target_limits;
  options.reference = file.reference_limits;
  options.attempts = file.attempts;
  options.jump_V = file.jump_V;
  options.coldest_degC = kColdest_degC;
  options.hottest_degC = kHottest_degC;
  options.stop_requested = StopWasAsked;
  return options;
}

std::string UtcText(std::time_t now) {
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

/// How long ago the run began. The wall clock is all that outlives a power failure; if it was set back meanwhile,
/// the run still goes on behind its last reading.
Duration SinceBegin(const Provenance& provenance, const std::vector<Reading>& readings) {
  const Duration last = readings.empty() ? Duration{} : readings.back().time.time_since_epoch();
  std::tm utc{};
  if (!strptime(provenance.clock_origin_utc.c_str(), "%Y-%m-%dT%H:%M:%SZ", &utc)) return last;
  return std::max<Duration>(last, std::chrono::seconds(std::time(nullptr) - timegm(&utc)));
}

/// @throws BenchError if the twin finds that the bench could not do it.
void RehearseFirst(const Scenario& scenario, const procedure::Options& limits, double mains_Hz) {
  const Rehearsal rehearsal = Rehearse(scenario, limits, mains_Hz);
  fmt::print(stderr, "{}", Summary(rehearsal, limits));
  if (!rehearsal.problems.empty()) throw BenchError("the rehearsal found problems; nothing was moved");
}

/// The record of a run that was begun before.
struct Begun {
  std::unique_ptr<RunRecord> record;
  std::vector<Reading> readings;
};

/// @throws InputError if the run was another scenario's.
void RequireSameScenario(const Scenario& scenario, const RunFolder& folder) {
  if (!std::filesystem::exists(folder.scenario())) {  // the program ended between making the record and writing it
    WriteFileAtOnce(folder.scenario(), WriteScenario(scenario));
  } else if (WriteScenario(LoadScenario(folder.scenario())) != WriteScenario(scenario)) {
    throw InputError(folder.path, "the run was begun with another scenario or other --set", "the same");
  }
}

Begun Resume(const Scenario& scenario, const RunFolder& folder) {
  Begun begun{RunRecord::Continue(folder.path), {}};
  RequireSameScenario(scenario, folder);
  begun.readings = begun.record->Readings();
  return begun;
}

std::unique_ptr<RunRecord> Begin(const Scenario& scenario, const RunFolder& folder, const hw::BenchFile& file,
                                 const std::string& identity) {
  const std::string origin = file.kind == "hardware" ? UtcText(std::time(nullptr)) : "";
  auto record =
      RunRecord::Create(folder.path, {TWINBENCH_VERSION, identity, scenario.seed, origin, scenario.bench});
  WriteFileAtOnce(folder.scenario(), WriteScenario(scenario));
  return record;
}

/// What was kept is not measured again; whatever was tried after it counts as an attempt that failed.
void TakeUp(const Begun& begun, const std::string& identity, procedure::Options& options) {
  const RunRecord& record = *begun.record;
  if (record.provenance().source != identity)
    throw BenchError(
        fmt::format("the run was begun on \"{}\" and this is \"{}\"", record.provenance().source, identity));
  options.readings_done = static_cast<int>(begun.readings.size());
  options.calls_done = record.Calls();
  const Time last = begun.readings.empty() ? Time{} : begun.readings.back().time;
  begun.record->AttemptFailed(options.readings_done, last, "interrupted", "the program ended; resumed");
  fmt::print(stderr, "twinbench: {} readings are kept; going on behind them\n", options.readings_done);
}

void CarryOutOn(RotaryBench bench, const Scenario& scenario, RunRecord& record, procedure::Options& options) {
  ProgressLine line;
  options.log = &record;
  if (bench.simulation) bench.simulation->Restart();
  procedure::CarryOut(bench, scenario, record, ShownOn(line), options);
  record.Finish();
}

void MeasureInto(const RunFolder& folder, const Scenario& scenario, const hw::BenchFile& file, Begun begun,
                 procedure::Options options) {
  const bool resumed = begun.record != nullptr;
  const Duration elapsed = resumed ? SinceBegin(begun.record->provenance(), begun.readings) : Duration{};
  const auto bench = OpenAnyBench(file, scenario, elapsed);
  if (resumed) TakeUp(begun, bench->Identity(), options);
  const auto record = resumed ? std::move(begun.record) : Begin(scenario, folder, file, bench->Identity());
  const auto note = [&](const std::vector<std::string>& lines) {
    for (const std::string& line : lines) record->AppendEvent(bench->Bench().clock.Now(), "adc", line);
  };
  note({bench->Identity()});
  note(bench->Configuration());
  try {
    CarryOutOn(bench->Bench(), scenario, *record, options);
    note(bench->Notices());
  } catch (const DeviceFault& fault) {
    const std::string why = fault.kind() == FaultKind::kStopped
                                ? "stopped by the operator"
                                : fmt::format("stopped: {} ({})", fault.what(), FaultName(fault.kind()));
    throw BenchError(why + ". The tables were brought to rest; every reading so far is kept. Go on with --resume");
  }
}

void Measure(const MeasureOptions& o) {
  const Scenario scenario = LoadScenario(o.scenario, o.overrides);
  if (!BenchOf(scenario).has_controllers)
    throw InputError(o.scenario, "no controllers for the bench " + scenario.bench,
                     BenchesWhere([](const Bench& bench) { return bench.has_controllers; }));
  const hw::BenchFile file = hw::LoadBenchFile(o.bench);
  const procedure::Options options = Carefulness(file);
  if (o.rehearse || o.rehearse_only) RehearseFirst(scenario, options, file.adc.mains_Hz);
  if (o.rehearse_only) return;
  if (o.folder.empty()) throw InputError("measure", "there is no -o", "-o DIR, a folder for the run");
  const RunFolder folder{o.folder};
  const bool resumes = o.resume && std::filesystem::exists(folder.path + "/record.sqlite");
  Begun begun = resumes ? Resume(scenario, folder) : Begun{};
  ListenForStop();
  if (!resumes || !begun.record->finished()) MeasureInto(folder, scenario, file, std::move(begun), options);
  EvaluateRun(scenario, folder.path);
}

}  // namespace

void AddMeasure(CLI::App& app) {
  auto* command =
      app.add_subcommand("measure", "Carry out a scenario on a real bench, a served one or a recording");
  auto options = std::make_shared<MeasureOptions>();
  command->add_option("scenario", options->scenario, "scenario file (TOML)")->required();
  command->add_option("--bench", options->bench, "bench file (TOML): the devices and how they are reached")
      ->required();
  command->add_option("-o,--output", options->folder, "folder of the run, made by the command");
  command->add_option("--set", options->overrides, "override a key of the scenario: procedure.positions=12")
      ->allow_extra_args(false);
  command->add_flag("--resume", options->resume, "go on behind the last reading that is kept");
  command->add_flag("--rehearse", options->rehearse,
                    "first on the twin: travel, spots on the PSDs, time it will take");
  command->add_flag("--rehearse-only", options->rehearse_only, "nothing but that");
  command->callback([options] { Measure(*options); });
}

}  // namespace twinbench::tools
