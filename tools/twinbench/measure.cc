#include "tools/twinbench/measure.h"

#include <fmt/core.h>

#include <algorithm>

#include "hw_bridge/bench_lock.h"
#include "hw_bridge/in_position.h"
#include "hw_bridge/program/program_file.h"
#include "hw_bridge/replay/replay_bench.h"
#include "tools/twinbench/commanded.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/evaluated_run.h"
#include "tools/twinbench/live_page.h"
#include "tools/twinbench/measured_run.h"
#include "tools/twinbench/opened_again.h"
#include "tools/twinbench/progress.h"
#include "tools/twinbench/real_bench.h"
#include "tools/twinbench/rehearsal.h"
#include "tools/twinbench/run_folder.h"
#include "tools/twinbench/stop_signal.h"
#include "tools/twinbench/told_link.h"
#include "tools/twinbench/told_stopped.h"
#include "twin/benches/claims.h"
#include "twin/benches/proof_by_steps.h"
#include "twin/benches/registry.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/core/errors.h"
#include "twin/core/input_text.h"
#include "twin/core/run_record.h"
#include "twin/core/toml_reader.h"
#include "twin/procedure/watch.h"
#include "twin/procedure/watched_moves.h"

namespace twinbench::tools {
namespace {

constexpr double kColdest_degC = -20.0, kHottest_degC = 60.0;  // beyond: no room that a bench stands in

/// Whether a person said when the mountings of a recorded run were done, so that nobody waited for them by the
/// clock.
bool HandEndedMounting(const std::string& record_folder) {
  return std::ranges::any_of(RunRecord::Open(record_folder)->Events(), [](const RecordedEvent& event) {
    return event.device == "fixture" && event.text.find(procedure::kMountedByHand) != std::string::npos;
  });
}

procedure::Options Carefulness(const hw::BenchFile& file, bool allow_homing) {
  procedure::Options options;
  options.may_home = allow_homing;
  options.target = file.target_limits;
  options.reference = file.reference_limits;
  options.attempts = file.attempts;
  options.jump_V = file.jump_V;
  options.coldest_degC = kColdest_degC;
  options.hottest_degC = kHottest_degC;
  options.stop_requested = StopWasAsked;
  if (file.kind == "replay")  // what was recorded was in position
    options.target.in_position_rad = options.reference.in_position_rad = std::numeric_limits<double>::infinity();
  options.hand_ends_mounting = file.kind == "replay" ? HandEndedMounting(file.record)
                                                     : file.kind == "hardware" && file.fixture.kind == "console";
  options.looks_at_encoders = file.kind != "replay" || hw::LooksAtEncoders(file.record);
  return options;
}

struct Asked {
  procedure::Options options;
  bool is_real = false;
};

/// With what the controllers of a bench of hardware say about their limits; they are asked, nothing moves.
Asked WithAgreedLimits(const procedure::Options& options, const hw::BenchFile& file, const Scenario& scenario) {
  Asked asked{options};
  if (file.kind != "hardware") return asked;
  const hw::BenchLock lock(hw::AddressesOf(file), "rehearse");
  const auto bench = OpenAnyBench(file, scenario, {});
  asked.is_real = IsRealBench(file.kind, bench->Bench().simulation);
  if (const auto limits = bench->Limits())
    asked.options.target = limits->target, asked.options.reference = limits->reference;
  return asked;
}

/// Nothing moves here.
/// @throws BenchError if the twin finds that the bench could not do it.
Rehearsal RehearseFirst(const Scenario& scenario, const procedure::Options& options, const hw::BenchFile& file) {
  const Asked asked = WithAgreedLimits(options, file, scenario);
  const Rehearsal rehearsal = Rehearse(scenario, asked.options, file.adc.mains_Hz, asked.is_real);
  fmt::print(stderr, "{}", Summary(rehearsal, asked.options));
  if (!rehearsal.problems.empty()) throw BenchError("the rehearsal found problems; nothing was moved");
  return rehearsal;
}

/// @param kind  Of the bench file: in a replay nothing moves that could be asked.
void CarryOutOn(RotaryBench devices, const Scenario& scenario, RunRecord& record, procedure::Options& options,
                const std::string& kind, LivePage& page) {
  const bool is_real = IsRealBench(kind, devices.simulation);
  procedure::WatchedTables watched(devices, options.target, options.reference);
  if (options.lost_zeros) watched.LoseZeros();
  RotaryBench bench = {devices.clock,
                       is_real ? watched.target() : devices.target,
                       is_real ? watched.reference() : devices.reference,
                       devices.adc,
                       devices.autocollimator,
                       devices.thermometer,
                       devices.goniometer,
                       devices.fixture,
                       devices.simulation};
  ProgressLine line;
  options.log = &record;
  if (is_real) options.prove = ProofBySteps(bench, scenario, options);
  if (kind != "replay") options.hear_fault = TellFault;
  const LinkWatch watch;
  if (bench.simulation) bench.simulation->Restart();
  StandingCheck stands;
  if (kind != "replay") stands = [&] { return procedure::WhetherBothStand(bench, options); };
  try {
    procedure::CarryOut(bench, scenario, record, page.ShownToo(ShownOn(line), stands), options);
  } catch (const std::exception& fault) {
    if (kind == "replay") throw;  // of a recording's tables nothing can be asked
    TellStopped(fault, "tables", [&] { return procedure::StopBoth(bench, options); });
  }
  ListenNoMore();
  record.Finish();
}

void MeasureInto(const RunFolder& folder, const Scenario& scenario, const hw::BenchFile& file, BegunRun begun,
                 procedure::Options options, LivePage& page) {
  const bool resumed = begun.record != nullptr;
  const hw::BenchLock lock(hw::AddressesOf(file), "measure into " + folder.path);
  const Duration since_begin = SinceBegin(begun);
  const auto bench =
      OpenedAgain(resumed ? file.attempts : 1, [&] { return OpenAnyBench(file, scenario, since_begin); });
  if (resumed) {
    options.lost_zeros = MayHaveLostZeros(begun);
    TakeUp(begun, bench->Identity());
    options.kept = begun.readings;
    options.calls_done = begun.record->Calls();
  }
  const auto record = resumed ? std::move(begun.record) : BeginRun(scenario, folder, file.kind, bench->Identity());
  page.Watch(*record, scenario, folder.path);
  bench->HearClock(
      [&](const std::string& notice) { record->AppendEvent(bench->Bench().clock.Now(), "clock", notice); });
  const auto note = [&](const std::vector<std::string>& lines) {
    for (const std::string& line : lines) record->AppendEvent(bench->Bench().clock.Now(), "adc", line);
  };
  note({bench->Identity()});
  note(bench->Configuration());
  CarryOutOn(bench->Bench(), scenario, *record, options, file.kind, page);
  note(bench->Notices());
}

/// A scenario, or the devices of another kind of bench, are told as such before their keys are.
void RequireBenchFileFor(const Scenario& scenario, const std::string& path) {
  const std::string text = InputText(path, "a bench file in TOML"), of = TextAtTop(text, path, "bench");
  const std::string wanted = "the file that says where the devices of " + scenario.bench +
                             " are; `twinbench serve SCENARIO --write-bench FILE` writes one";
  if (!of.empty()) throw InputError(path, "a scenario of " + of + ", no bench file", wanted);
  const bool is_driven = BenchOf(scenario).drive != nullptr;
  const std::string table = is_driven ? "adc" : "machine";  // what the other kind has
  if (HasTable(text, path, table))
    throw InputError(path,
                     fmt::format("a bench file with [{}], so of {}", table,
                                 is_driven ? "two tables with an AD converter" : "a machine"),
                     wanted);
}

}  // namespace

void Measure(const MeasureOptions& o, LivePage& page, JsonAnswer& answer) {
  RequireOutput(answer.to(), {o.scenario, o.bench});
  Scenario scenario = LoadScenario(o.scenario, o.overrides);
  RequireBenchFileFor(scenario, o.bench);
  for (const std::string& table : o.compensations) CommandCompensation(scenario, table);
  if (hw::IsProgramFile(o.bench)) return MeasureByProgram(o, scenario, page, answer);
  if (!BenchOf(scenario).has_controllers)
    throw InputError(o.scenario, "no controllers for the bench " + scenario.bench,
                     BenchesWhere([](const Bench& bench) { return bench.has_controllers; }));
  if (BenchOf(scenario).drive) return MeasureMachine(o, scenario, page, answer);
  hw::BenchFile file = hw::LoadBenchFile(o.bench);
  if (file.kind == "hardware") {
    for (const Claim& claim : ClaimsOf(scenario)) hw::TieToClaim(file, claim.axis, claim.u, claim.less);
  }
  const procedure::Options options = Carefulness(file, o.allow_homing);
  if (o.rehearse_only) return answer.Write(RehearsalJson(RehearseFirst(scenario, options, file)));
  if (o.rehearse) RehearseFirst(scenario, options, file);
  const RunFolder folder = FolderOf(o);
  BegunRun begun = TakeUpIfAsked(o, scenario, folder);
  const bool resumes = begun.record != nullptr;
  ListenForStop(kStopIsHeard);
  if (!resumes || !begun.record->finished()) MeasureInto(folder, scenario, file, std::move(begun), options, page);
  EvaluateMeasured(scenario, folder.path, answer);
}

void AddMeasure(CLI::App& app) {
  auto* command =
      app.add_subcommand("measure", "Measure a scenario on a real bench, an emulated one or a recording");
  auto options = std::make_shared<MeasureOptions>();
  command->add_option("scenario", options->scenario, "scenario file (TOML)")->required();
  command->add_option("--bench", options->bench, "bench file (TOML): the devices and how they are reached")
      ->required();
  AddOutput(*command, options->folder, "the folder of the run");
  AddSet(*command, options->overrides);
  command
      ->add_option("--compensation", options->compensations,
                   "target=FILE.csv: corrections that table is commanded with")
      ->allow_extra_args(false);
  command->add_flag("--resume", options->resume, "go on behind the last reading that is kept");
  command->add_flag("--allow-homing", options->allow_homing,
                    "a table or machine whose controller has lost its origin may be driven to find it");
  command->add_flag("--rehearse", options->rehearse, "simulate it first: travel, spots on the PSDs, duration");
  command->add_flag("--rehearse-only", options->rehearse_only, "simulate it only");
  AddWebOption(*command, options->web);
  AnswerWith(*command, "what came of the run", [options](JsonAnswer& answer) {
    WithLivePage(options->web, "measure", [&](LivePage& page) { Measure(*options, page, answer); });
  });
}

}  // namespace twinbench::tools
