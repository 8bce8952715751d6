#include <algorithm>
#include <memory>
#include <utility>

#include "twin/core/bench_format.h"
#include "twin/core/device_fault.h"
#include "twin/core/machine_call.h"
#include "twin/core/run_log.h"
#include "twin/procedure/attempts.h"
#include "twin/procedure/machine_sequencer.h"
#include "twin/procedure/machine_watch.h"

namespace twinbench::procedure {
namespace {

/// The devices of a machine bench; every call is written down with its answer before anybody sees it, so that the run can be
/// played back.
class MachineJournal {
 public:
  /// @param shown  InstrumentColumns of the bench.
  /// @param log    None: nothing is written down, and the bench is used as it is. Text costs more than a simulated reading
  ///               does.
  MachineJournal(MachineBench inner, const std::vector<ReadingColumn>& shown, RunLog* log)
      : inner_(inner), shown_(shown), log_(log) {
    if (!log_) return;
    asked_ = std::make_unique<AskedMachine>(
        [this](const std::string& device, const std::string& request) { return AskInner(device, request); },
        [this] { return Now(); },
        AskedMachine::Parts{inner.machine.Axes(), shown, inner.indexer != nullptr, inner.simulation});
  }

  MachineBench Bench() { return log_ ? asked_->Bench() : inner_; }

  /// Says that the way begins: from the start on a simulated bench, with the first reading that is missing on a real one.
  void BeginAttempt() {
    if (log_) Note(inner_.clock.Now(), kRunDevice, kAttemptBegins, inner_.simulation ? kOnSimulation : kOnRealBench);
  }

 private:
  std::string AskInner(const std::string& device, const std::string& request) {
    std::string answer = Perform(inner_, shown_, device, request);
    Note(inner_.clock.Now(), device, request, answer);
    return answer;
  }

  /// A simulated clock shows what it showed at the end of the last call. A real one goes on, and where it is looked at the
  /// way may depend on it.
  Time Now() {
    const Time now = inner_.clock.Now();
    if (now != noted_) Note(now, kClockDevice, kClockShows, "");
    return now;
  }

  void Note(Time time, const std::string& device, const std::string& request, const std::string& answer) {
    log_->Called({time, device, request, answer});
    noted_ = time;
  }

  MachineBench inner_;
  std::vector<ReadingColumn> shown_;
  RunLog* log_;
  Time noted_{};  // of the last call in the log
  std::unique_ptr<AskedMachine> asked_;
};

/// Somebody else had the axes, and nothing that was read at rest tells whether their zeros and units are still the
/// same.
bool IsBeyondProof(const DeviceFault& fault, const MachineRunState& state, const MachineOptions& options) {
  const bool reads_at_rest = state.kept.empty() || WasAtRest(state.kept.back());
  return fault.kind() == FaultKind::kMoved && options.require_as_before && reads_at_rest &&
         !CanProve(state, options);
}

/// How a resumed run finds a real bench: as the last reading left it.
MachineRunState StateBehind(const MachineBench& bench, const MachineOptions& options) {
  MachineRunState state{options.kept, {}};
  if (!bench.simulation && !options.kept.empty()) state.mounted = options.kept.back().setup;
  state.is_doubted = options.lost_zeros;
  return state;
}

/// The time of a fault; where the clock is what has failed, of the last reading.
Time TimeOf(MachineBench& bench, const MachineRunState& state) {
  try {
    return bench.clock.Now();
  } catch (const BenchError&) {
    return state.kept.empty() ? Time{} : state.kept.back().time;
  }
}

/// A simulation starts again; what was taken before passes without taking any time.
void StartAgain(MachineBench& bench, const MachineRunState& state) {
  if (!bench.simulation) return;
  bench.simulation->Restart();
  bench.simulation->SetPaced(state.kept.empty());
}

/// Finding origins drives axes through ways that no procedure planned, and what is mounted goes with them.
void HomeAgain(MachineBench& bench, const MachineRunState& state, const MachineOptions& options) {
  const bool turns_alone = std::ranges::all_of(bench.machine.Axes(), &MachineAxis::is_rotary);
  if (!turns_alone && state.mounted)
    throw DeviceFault(
        FaultKind::kRefused, "machine",
        "has lost its origin with an instrument mounted: take it off, find the origins, put it back and go on with "
        "--resume");
  if (!options.may_home)
    throw DeviceFault(FaultKind::kRefused, "machine",
                      "has lost its origin, and finding it moves the machine: look whether it may, then agree with "
                      "--allow-homing");
  bench.machine.Home();
  if (options.log) options.log->AppendEvent(bench.clock.Now(), "machine", "has found its origin again");
}

/// A controller tells no speed back that it was sent: what was to end may turn on, unseen by anybody who looks no more.
void LeaveAtRest(MachineBench& bench, const MachineSequencer& sequencer, const MachineOptions& options) {
  if (bench.simulation || !sequencer.HasTurned() || StopMachine(bench, options).is_sure) return;
  throw DeviceFault(FaultKind::kFollowing, "machine", "turns on behind the last reading");
}

}  // namespace

void RequireOneRotaryAxis(const std::vector<MachineAxis>& axes, const std::string& axis) {
  if (axes.size() != 1 || !axes[0].is_rotary)
    throw DeviceFault(FaultKind::kRefused, "machine", "this bench has one axis, " + axis);
}

void CarryOutPlan(MachineBench& bench, const MachinePlan& plan, const MachineWay& way, ReadingSink& sink,
                  const ProgressCallback& progress, const MachineOptions& options) {
  MachineJournal journal(bench, InstrumentColumns(FormatOf(plan.bench).columns), options.log);
  MachineRunState state = StateBehind(bench, options);
  Attempts attempts(options.attempts);
  for (bool anew = !state.kept.empty();; anew = true) {
    MachineSequencer sequencer(journal.Bench(), plan, sink, options, progress, state);
    try {
      if (anew) StartAgain(bench, state);
      if (std::exchange(state.lost_origin, false)) HomeAgain(bench, state, options);
      journal.BeginAttempt();
      if (bench.simulation) state.mounted.reset();
      way(sequencer);
      sequencer.Flush();
      return LeaveAtRest(bench, sequencer, options);
    } catch (const DeviceFault& fault) {
      if (options.hear_fault) options.hear_fault(fault);
      const Standstill stands = StopMachine(bench, options);
      sequencer.Flush();
      if (options.log) options.log->ForgetCalls();
      const int next = static_cast<int>(state.kept.size());
      NoteFailure(options.log, next, TimeOf(bench, state), fault);
      if (!options.log || !stands.is_sure || !IsWorthAnotherAttempt(fault.kind()) ||
          IsBeyondProof(fault, state, options) || !attempts.AnotherAt(next))
        throw StoppedRun(fault, stands);
      state.lost_origin = fault.kind() == FaultKind::kRestarted && !bench.simulation;
      state.is_doubted = true;
    } catch (...) {  // whatever it is, nothing goes on moving
      StopMachine(bench, options);
      throw;
    }
  }
}

}  // namespace twinbench::procedure
