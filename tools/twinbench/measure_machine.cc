#include "tools/twinbench/measure.h"

#include <fmt/core.h>

#include <algorithm>

#include "hw_bridge/bench_lock.h"
#include "hw_bridge/in_position.h"
#include "hw_bridge/open_machine.h"
#include "hw_bridge/replay/replay_machine.h"
#include "tools/twinbench/evaluated_run.h"
#include "tools/twinbench/machine_rehearsal.h"
#include "tools/twinbench/opened_again.h"
#include "tools/twinbench/progress.h"
#include "tools/twinbench/real_bench.h"
#include "tools/twinbench/stop_signal.h"
#include "tools/twinbench/told_link.h"
#include "tools/twinbench/told_stopped.h"
#include "twin/benches/claims.h"
#include "twin/benches/expected.h"
#include "twin/benches/proof_by_steps.h"
#include "twin/benches/registry.h"
#include "twin/core/bench_format.h"
#include "twin/procedure/jumps.h"
#include "twin/procedure/machine_options.h"
#include "twin/procedure/machine_watch.h"
#include "twin/procedure/watched_moves.h"

namespace twinbench::tools {
namespace {

constexpr double kColdestRoom_degC = -20.0, kHottestRoom_degC = 60.0;

/// The program's own twin as a bench of devices.
class OwnMachine : public hw::OpenMachine {
 public:
  explicit OwnMachine(std::unique_ptr<MachineDevices> twin) : twin_(std::move(twin)) {}
  MachineBench Devices() override { return twin_->Devices(); }
  std::string Identity() const override { return "twin"; }
  std::vector<AxisLimits> Limits() const override { return twin_->Devices().machine.Travel(); }

 private:
  std::unique_ptr<MachineDevices> twin_;
};

/// A recorded run. What its devices were allowed was asked when it was recorded.
class RecordedMachine : public hw::OpenMachine {
 public:
  RecordedMachine(std::string folder, const std::vector<MachineAxis>& axes, const std::vector<ReadingColumn>& columns,
                  bool indexer)
      : folder_(std::move(folder)), replay_(folder_, axes, columns, indexer), axes_(axes.size()) {}
  MachineBench Devices() override { return replay_.Devices(); }
  std::string Identity() const override { return "replay of " + folder_; }
  std::vector<AxisLimits> Limits() const override {
    constexpr double kAny = std::numeric_limits<double>::infinity();
    return std::vector<AxisLimits>(axes_, {.stall_s = kAny, .move_timeout_s = kAny});
  }
  int Attempts() const { return replay_.Attempts(); }
  bool IsOfSimulation() const { return replay_.IsOfSimulation(); }

 private:
  std::string folder_;
  hw::ReplayMachine replay_;
  std::size_t axes_;
};

/// What the bench of a scenario must have, by its twin.
struct MachineParts {
  std::vector<MachineAxis> axes;
  bool indexer = false;
};

MachineParts PartsOf(const Scenario& scenario) {
  const auto twin = BenchOf(scenario).make_devices(scenario);
  const MachineBench devices = twin->Devices();
  return {devices.machine.Axes(), devices.indexer != nullptr};
}

std::unique_ptr<hw::OpenMachine> OpenAnyMachine(const hw::MachineFile& file, const Scenario& scenario,
                                                const MachineParts& parts, Duration elapsed) {
  const Bench& bench = BenchOf(scenario);
  if (file.kind == "twin") return std::make_unique<OwnMachine>(bench.make_devices(scenario));
  const std::vector<ReadingColumn> columns = InstrumentColumns(bench.format->columns);
  if (file.kind == "replay")
    return std::make_unique<RecordedMachine>(file.record, parts.axes, columns, parts.indexer);
  if (parts.indexer && file.indexer.kind == "none")
    throw InputError(file.path, "there is no [indexer] to turn the multi-tooth table",
                     "[indexer] with kind = \"scpi\" or \"console\"");
  return hw::OpenMachineHardware(file, parts.axes, columns, elapsed, scenario.repeat, StopWasAsked);
}

/// Nothing moves here. @throws BenchError if the twin finds that the bench could not do it.
MachineRehearsal RehearseMachineFirst(const Scenario& scenario, const std::vector<MachineAxis>& axes,
                                      hw::OpenMachine& opened, const std::string& kind) {
  const std::vector<AxisLimits> limits = opened.Limits();
  const MachineRehearsal rehearsal = RehearseMachine(scenario, limits, IsRealBench(kind, opened.Devices().simulation));
  fmt::print(stderr, "{}", Summary(rehearsal, axes, limits));
  if (!rehearsal.problems.empty()) throw BenchError("the rehearsal found problems; nothing was moved");
  return rehearsal;
}

procedure::MachineOptions Carefully(const hw::MachineFile& file, const hw::OpenMachine& bench,
                                    const BegunRun& begun, bool allow_homing) {
  procedure::MachineOptions options;
  options.may_home = allow_homing;
  options.axes = bench.Limits();
  options.attempts = file.attempts;
  options.coldest_degC = kColdestRoom_degC;
  options.hottest_degC = kHottestRoom_degC;
  options.stop_requested = StopWasAsked;
  options.kept = begun.readings;
  options.lost_zeros = MayHaveLostZeros(begun);
  if (const auto* replay = dynamic_cast<const RecordedMachine*>(&bench)) {
    options.attempts = replay->Attempts();
    if (!replay->IsOfSimulation() && !options.kept.empty())
      throw InputError("--resume", "the replay of a real bench's run begins at its first reading",
                       "another folder for it");
  }
  return options;
}

/// What the scenario claims of what the instruments show.
std::vector<procedure::ClaimedColumn> ClaimedColumns(const Scenario& scenario) {
  const BenchFormat& format = FormatOf(scenario.bench);
  std::vector<procedure::ClaimedColumn> claims;
  for (const plausible::Expected& expected : ExpectedOf(scenario, {})) {
    const auto column = std::ranges::find(format.columns, expected.column, &ReadingColumn::name);
    const double range = format.range_of ? format.range_of(scenario, expected.column) : 0.0;
    claims.push_back({*column, scenario.noise_free ? 0.0 : expected.noise, range, expected.is_loose ? nullptr : expected.nominal, expected.is_angle,
                      expected.by_axes && !expected.nominal});
  }
  return claims;
}

/// @param kind  Of the bench file: in a replay nothing moves that could be asked.
void DriveInto(RunRecord& record, const Scenario& scenario, hw::OpenMachine& opened,
               procedure::MachineOptions options, const std::string& kind, LivePage& page) {
  const MachineBench devices = opened.Devices();
  procedure::DoubtedInstruments doubted(devices.instruments, ClaimedColumns(scenario));
  // A simulated bench is read as often as its run asks, so that it is that run.
  const bool is_real = IsRealBench(kind, devices.simulation);
  procedure::WatchedMachine watched(devices.machine, devices.clock, options.axes);
  const bool turns_alone = std::ranges::all_of(devices.machine.Axes(), &MachineAxis::is_rotary);  // others are homed by hand
  if (options.lost_zeros && turns_alone) watched.LoseZeros();
  InstrumentSet& instruments = is_real ? doubted : devices.instruments;
  MachineController& machine = is_real ? watched : devices.machine;
  MachineBench bench = {devices.clock, machine, instruments, devices.fixture, devices.simulation, devices.indexer};
  ProgressLine line;
  options.log = &record;
  if (is_real) options.prove = ProofBySteps(bench, scenario, options);
  if (kind != "replay") options.hear_fault = TellFault;
  const LinkWatch watch;
  StandingCheck stands;
  if (kind != "replay") stands = [&] { return procedure::WhetherMachineStands(bench, options); };
  if (bench.simulation && options.kept.empty()) bench.simulation->Restart();
  try {
    BenchOf(scenario).drive(bench, scenario, record, page.ShownToo(ShownOn(line), stands), options);
  } catch (const std::exception& fault) {
    if (kind == "replay") throw;  // of a recording's axes nothing can be asked
    TellStopped(fault, "axes", [&] { return procedure::StopMachine(bench, options); });
  }
  ListenNoMore();
  record.Finish();
}

/// Its readings are judged, and so are those in the replay of such a bench.
bool IsJudged(const hw::MachineFile& file, hw::OpenMachine& bench) {
  const auto* replay = dynamic_cast<const RecordedMachine*>(&bench);
  return replay ? !replay->IsOfSimulation() : IsRealBench(file.kind, bench.Devices().simulation);
}

void MeasureMachineInto(const RunFolder& folder, const Scenario& scenario, const hw::MachineFile& file,
                        hw::OpenMachine& bench, BegunRun begun, bool allow_homing, LivePage& page) {
  const bool resumed = begun.record != nullptr;
  if (resumed) TakeUp(begun, bench.Identity());
  procedure::MachineOptions options = Carefully(file, bench, begun, allow_homing);
  if (IsJudged(file, bench)) {
    using std::placeholders::_1, std::placeholders::_2;
    options.require_no_jump = std::bind(procedure::RequireNoJump, ClaimedColumns(scenario), _1, _2);
    options.require_goes_along = std::bind(procedure::RequireGoesAlong, ClaimedColumns(scenario), _1, _2);
    options.require_as_before = std::bind(procedure::RequireAsBefore, ClaimedColumns(scenario), _1, _2);
  }
  const auto record = resumed ? std::move(begun.record) : BeginRun(scenario, folder, file.kind, bench.Identity());
  bench.HearClock([&](const std::string& notice) { record->AppendEvent(bench.Devices().clock.Now(), "clock", notice); });
  record->AppendEvent(bench.Devices().clock.Now(), "bench", bench.Identity());
  page.Watch(*record, scenario, folder.path);
  DriveInto(*record, scenario, bench, options, file.kind, page);
}

}  // namespace

void MeasureMachine(const MeasureOptions& o, const Scenario& scenario, LivePage& page, JsonAnswer& answer) {
  const MachineParts parts = PartsOf(scenario);
  hw::MachineFile file = hw::LoadMachineFile(o.bench, parts.axes);
  if (file.kind == "hardware") {
    for (const Claim& claim : ClaimsOf(scenario)) hw::TieToClaim(file, parts.axes, claim.axis, claim.u, claim.less);
  }
  if (o.rehearse_only)
    return answer.Write(RehearsalJson(RehearseMachineFirst(scenario, parts.axes, *OpenAnyMachine(file, scenario, parts, {}), file.kind), parts.axes));
  const RunFolder folder = FolderOf(o);
  BegunRun begun = TakeUpIfAsked(o, scenario, folder);
  ListenForStop(kStopIsHeard);
  if (!begun.record || !begun.record->finished()) {
    const hw::BenchLock lock(hw::AddressesOf(file), "measure into " + folder.path);
    const Duration since_begin = SinceBegin(begun);
    const auto bench = OpenedAgain(begun.record ? file.attempts : 1,
                                   [&] { return OpenAnyMachine(file, scenario, parts, since_begin); });
    if (o.rehearse) RehearseMachineFirst(scenario, parts.axes, *bench, file.kind);
    MeasureMachineInto(folder, scenario, file, *bench, std::move(begun), o.allow_homing, page);
  }
  EvaluateMeasured(scenario, folder.path, answer);
}

}  // namespace twinbench::tools
