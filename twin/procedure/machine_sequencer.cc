#include "twin/procedure/machine_sequencer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/bench_format.h"
#include "twin/core/device_fault.h"
#include "twin/procedure/attempts.h"
#include "twin/procedure/machine_journal.h"
#include "twin/procedure/machine_watch.h"
#include "twin/procedure/plausible.h"

namespace twinbench::procedure {
namespace {

/// The plan counts in nanoseconds that are rounded; so much later is in time.
constexpr Duration kInTime = std::chrono::microseconds(1);
constexpr double kTraverseAtLeast_m_s = 1e-3, kTurnAtLeast_rad_s = 1.0 * units::deg;

/// A run on a real bench keeps what it has at once; simulated readings come too fast to be waited for one by one.
constexpr std::size_t kTogetherWatched = 32, kTogetherAlone = 256;

double Radius_m(const Arc& arc, const std::vector<AxisState>& from) {
  return std::hypot(from[arc.axes[0]].encoder - arc.centre_m[0], from[arc.axes[1]].encoder - arc.centre_m[1]);
}

/// Whether the last reading can be taken again.
bool CanProve(const MachineRunState& state, const MachineOptions& options) {
  if (!options.require_as_before || state.kept.empty()) return false;
  return state.mounted == state.kept.back().setup && WasAtRest(state.kept.back());
}

/// Somebody else had the axes, and nothing that was read at rest tells whether their zeros and units are still the same.
bool IsBeyondProof(const DeviceFault& fault, const MachineRunState& state, const MachineOptions& options) {
  const bool reads_at_rest = state.kept.empty() || WasAtRest(state.kept.back());
  return fault.kind() == FaultKind::kMoved && options.require_as_before && reads_at_rest && !CanProve(state, options);
}

}  // namespace

MachineSequencer::MachineSequencer(MachineBench bench, const MachinePlan& plan, ReadingSink& sink,
                                   const MachineOptions& options, const ProgressCallback& progress,
                                   MachineRunState& state)
    : bench_(bench), plan_(plan), sink_(sink), options_(options), progress_(progress), state_(state), where_(bench_.machine.Axes(), options.axes) {}

std::vector<double> MachineSequencer::Where() {
  std::vector<double> at;
  for (const AxisState& axis : bench_.machine.State()) at.push_back(axis.encoder);
  return at;
}

std::vector<double> MachineSequencer::WhereSent() {
  std::vector<double> at;
  for (const AxisState& axis : bench_.machine.State()) at.push_back(std::isnan(axis.commanded) ? axis.encoder : axis.commanded);
  return at;
}

int MachineSequencer::From(int first, int end) const {
  return bench_.simulation ? first : std::clamp(static_cast<int>(state_.kept.size()) - (state_.is_doubted && CanProve(state_, options_) ? 1 : 0), first, end);
}

void MachineSequencer::ThroughPasses(const std::function<void(int first, int end)>& take) {
  const int readings = static_cast<int>(plan().size());
  const auto pass_of = [this](int reading) { return plan()[static_cast<std::size_t>(reading)].pass; };
  for (int first = 0, end = 0; first < readings; first = end) {
    while (end < readings && pass_of(end) == pass_of(first)) ++end;
    const int from = From(first, end);
    if (from < end) take(from, end);
  }
}

void MachineSequencer::Clear() {
  bench_.fixture.Clear();
  state_.mounted.reset();
}

void MachineSequencer::Mount(int setup, const std::string& what) {
  bench_.fixture.Mount(setup, what);
  state_.mounted = setup;
  if (options_.log)
    options_.log->AppendEvent(bench_.clock.Now(), "fixture", fmt::format("mounting {}: {}", setup, what));
}

void MachineSequencer::Pause(Duration duration) {
  WaitFor(bench_, duration, options_);
}

void MachineSequencer::LetHandsWork(Duration duration) {
  if (bench_.simulation) WaitFor(bench_, duration, options_);
}

void MachineSequencer::Rest(int reading, Duration duration) {
  if (reading == 0) return;
  const Time until = plan()[static_cast<std::size_t>(reading) - 1].time + duration;
  WaitFor(bench_, until - bench_.clock.Now(), options_);
}

void MachineSequencer::MoveTo(const std::vector<double>& to) {
  Move(to, [] {});
}

/// Nobody else may have sent it anywhere since it was last looked at.
std::vector<AxisState> MachineSequencer::LookBeforeMotion() {
  std::vector<AxisState> states = bench_.machine.State();
  where_.RequireOurs(states);
  return states;
}

void MachineSequencer::Move(const std::vector<double>& to, const std::function<void()>& meanwhile) {
  HearOperator(options_);
  const std::vector<AxisState> from = LookBeforeMotion();
  RequireMayGo(axes(), from, to, options_);
  double takes_s = 0.0;
  for (std::size_t k = 0; k < to.size(); ++k)
    takes_s += std::abs(to[k] - from[k].encoder) / (axes()[k].is_rotary ? kTurnAtLeast_rad_s : kTraverseAtLeast_m_s);
  bench_.machine.StartMove(to, 0.0);
  where_.SentTo(to);
  meanwhile();
  Watch(bench_, takes_s, where_, options_);
}

void MachineSequencer::MoveAndIndex(const std::vector<double>& to, int tooth, double tooth_rad) {
  if (!bench_.indexer)
    throw DeviceFault(FaultKind::kRefused, "indexer", "there is none; the multi-tooth table cannot be turned");
  if (!bench_.indexer->IsByHand()) return Move(to, [&] { Index(tooth, tooth_rad); });
  MoveTo(to);
  Index(tooth, tooth_rad);
}

void MachineSequencer::Index(int tooth, double tooth_rad) {
  HearOperator(options_);
  bench_.indexer->IndexTo(tooth, tooth_rad);
}

double MachineSequencer::PathTime_s(const Arc& arc, double radius_m) const {
  return std::abs(arc.sweep_rad) * radius_m / (arc.feed_m_s > 0.0 ? arc.feed_m_s : kTraverseAtLeast_m_s);
}

void MachineSequencer::Go(const Arc& arc) {
  HearOperator(options_);
  const std::vector<AxisState> from = LookBeforeMotion();
  bench_.machine.StartArc(arc);
  where_.SentRound(arc, from);
  Watch(bench_, PathTime_s(arc, Radius_m(arc, from)), where_, options_);
}

void MachineSequencer::Sweep(const Arc& arc, int first, int end) {
  const std::vector<Reading> samples = SamplesAlong(arc, static_cast<std::size_t>(end - first));
  for (const Reading& sample : samples) Keep(first++, sample);
}

/// All of them or none: behind a trigger that latched nothing every sample would stand one place too early.
std::vector<Reading> MachineSequencer::SamplesAlong(const Arc& arc, std::size_t triggers) {
  HearOperator(options_);
  if (options_.log) options_.log->RequireRoom();
  const std::vector<AxisState> from = LookBeforeMotion();
  const double radius_m = Radius_m(arc, from);
  std::vector<Reading> samples;
  Arm(static_cast<int>(triggers), 0);
  bench_.machine.StartArc(arc);
  where_.SentRound(arc, from);
  Watch(bench_, PathTime_s(arc, radius_m), where_, options_, [&] {
    const LatchedSamples latched = Latched();
    if (latched.overrun)
      throw DeviceFault(FaultKind::kOverrun, "instruments", "their memory ran full; samples are lost");
    for (const Reading& sample : latched.samples) {
      if (samples.size() == triggers)
        throw DeviceFault(FaultKind::kProtocol, "instruments", "more samples came than there were triggers");
      samples.push_back(sample);
    }
  });
  if (samples.size() < triggers)
    throw DeviceFault(FaultKind::kGap, "instruments",
                      fmt::format("the path has ended and {} of {} triggers latched nothing", triggers - samples.size(), triggers));
  RequirePace(arc, radius_m, samples);
  return samples;
}

void MachineSequencer::RequirePace(const Arc& arc, double radius_m, const std::vector<Reading>& samples) const {
  constexpr double kShare = 0.1, kStamped_s = 1.0;  // an instrument may stamp when it is looked at
  if (arc.feed_m_s <= 0.0) return;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const double takes_s = static_cast<double>(k) * arc.trigger_step_rad * radius_m / arc.feed_m_s;
    const double took_s = ToSeconds(samples[k].time - samples.front().time);
    if (std::abs(took_s - takes_s) <= kShare * takes_s + kStamped_s) continue;
    throw DeviceFault(FaultKind::kFollowing, "machine",
                      fmt::format("took {:.3g} s from the first trigger to the {}th and takes {:.3g} s at its feed of {:.6g} mm/min: is an "
                                  "override set?",
                                  took_s, k + 1, takes_s, arc.feed_m_s / units::mm * 60.0));
  }
}

void MachineSequencer::Arm(int samples, int lines) {
  armed_ = bench_.clock.Now();
  bench_.instruments.Arm(samples, lines);
}

LatchedSamples MachineSequencer::Latched() {
  LatchedSamples latched = bench_.instruments.Latched();
  const Time now = bench_.clock.Now();
  for (const Reading& sample : latched.samples) RequireTimely(sample, armed_, now);
  return latched;
}

void MachineSequencer::StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) {
  HearOperator(options_);
  LookAtTurning();
  const Time before = Now();
  bench_.machine.StartTurning(axis, speed_rad_s, ramp);
  where_.Released(axis);
  turning_.Told(before, Now(), speed_rad_s, ramp);
}

AxisState MachineSequencer::LookAtTurning() {
  const Time before = Now();
  const AxisState state = RequireMayTurn(bench_, options_)[0];
  turning_.Look(axes()[0], state.encoder, before, Now());
  return state;
}

void MachineSequencer::Turn(std::size_t axis, double speed_rad_s, Duration ramp) {
  StartTurning(axis, speed_rad_s, ramp);
  WaitFor(bench_, ramp, options_);
}

void MachineSequencer::TakeInMotion(int reading, Time due, Duration late, const std::function<void(Reading&)>& enter) {
  PauseUntil(due);
  const Time asked = Now();
  const Reading sample = bench_.instruments.Read();
  const Time now = Now();
  RequireTimely(sample, asked, now);
  if (now > due + late)
    throw DeviceFault(FaultKind::kOverrun, "instruments",
                      fmt::format("a reading in motion came {:.3g} s late: they answer more slowly than they are asked",
                                  ToSeconds(now - due)));
  LookAtTurning();
  KeepAndHear(reading, sample, enter);
}

void MachineSequencer::Collect(int first, int end, int lines, Duration poll) {
  constexpr Duration kNothingComes = std::chrono::minutes(1);
  HearOperator(options_);
  if (options_.log) options_.log->RequireRoom();
  Arm(end - first, lines);
  Duration in_vain{0};
  std::optional<Reading> before;
  // From before a fault to behind it whole turns may be lost, so that a wrong sample passes alone: those of one look come together.
  const auto require_go_along = [&](const std::vector<Reading>& samples, int from) {
    for (std::size_t k = 1; k < samples.size() && from + static_cast<int>(k) < end; ++k) {
      const auto planned = static_cast<std::size_t>(from) + k;
      options_.require_goes_along(Joined(plan()[planned], samples[k]), Joined(plan()[planned - 1], samples[k - 1]));
    }
  };
  for (int next = first; next < end;) {
    WaitFor(bench_, poll, options_);
    LookAtTurning();
    const LatchedSamples latched = Latched();
    if (options_.require_goes_along) require_go_along(latched.samples, next);
    for (const Reading& sample : latched.samples) {
      if (before && !IsSimulated()) RequireAnother(sample, *before, plan_.bench);
      before = sample;
      if (next == end)
        throw DeviceFault(FaultKind::kProtocol, "instruments", "more samples came than they were armed for");
      KeepAndHear(next++, sample);
    }
    if (latched.overrun)
      throw DeviceFault(FaultKind::kOverrun, "instruments",
                        "their memory ran full; look at it more often (poll_s) or keep fewer lines (samples_per_turn)");
    in_vain = latched.samples.empty() ? in_vain + poll : Duration(0);
    if (in_vain > kNothingComes)
      throw DeviceFault(FaultKind::kStalled, "instruments", "no line of the encoder for a minute");
  }
}

void MachineSequencer::TakeAtRest(int reading, Duration dwell, const std::function<void(Reading&)>& enter) {
  if (options_.log) options_.log->RequireRoom();
  WaitUntilDue(reading, dwell);
  std::vector<Stood> stood;
  const Reading sample = ReadAtRest(stood);
  for (const Stood& axis : stood) RequireStood(axis);
  if (options_.prove) options_.prove(Joined(plan()[static_cast<std::size_t>(reading)], sample));
  KeepAndHear(reading, sample, [&](Reading& r) {
    for (const Stood& axis : stood) EnterInto(r, axis);
    if (enter) enter(r);
  });
}

/// @param stood  Becomes where they stood, one entry an axis.
Reading MachineSequencer::ReadAtRest(std::vector<Stood>& stood) {
  LookAtAxes(stood, &Stood::before);
  const Time asked = bench_.clock.Now();
  Reading sample = bench_.instruments.Read();
  RequireTimely(sample, asked, bench_.clock.Now());
  LookAtAxes(stood, &Stood::after);
  return sample;
}

/// @param stood  One entry an axis; made by the first look.
void MachineSequencer::LookAtAxes(std::vector<Stood>& stood, double Stood::*when) {
  const std::vector<AxisState> states = bench_.machine.State();
  where_.RequireOurs(states);
  for (std::size_t k = 0; k < states.size(); ++k) {
    if (k == stood.size()) {
      const double sent = where_.Sent(k, states[k]), at = std::isnan(sent) ? states[k].encoder : sent;
      stood.push_back({axes()[k].name, axes()[k].is_rotary, at, kNaN, kNaN, where_.Tolerance(k)});
    }
    if (states[k].moving) throw DeviceFault(FaultKind::kMoved, axes()[k].name, "moves while it is read, as its controller says");
    stood[k].*when = StoodAt(axes()[k], states[k]);
  }
}

Reading MachineSequencer::Look() {
  HearOperator(options_);
  return bench_.instruments.Look();
}

void MachineSequencer::WaitUntilDue(int reading, Duration dwell) {
  const Duration left = plan()[static_cast<std::size_t>(reading)].time - bench_.clock.Now();
  WaitFor(bench_, left + kInTime >= dwell ? left : dwell, options_);
}

/// What was planned with what was shown.
Reading MachineSequencer::Joined(const Reading& planned, const Reading& sample) const {
  Reading joined = planned;
  joined.time = sample.time;
  joined.status = sample.status;
  joined.temperature_degC = sample.temperature_degC;
  Reading shown = sample;
  for (const ReadingColumn& column : FormatOf(plan_.bench).columns) {
    if (IsOfInstruments(column) && !column.print(sample).empty())
      column.number(joined) = column.number(shown);
  }
  return joined;
}

void MachineSequencer::Keep(int number, const Reading& sample, const std::function<void(Reading&)>& enter) {
  Reading reading = Joined(plan()[static_cast<std::size_t>(number)], sample);
  if (enter) enter(reading);
  if (plan_.complete) plan_.complete(reading);
  if (!bench_.simulation) RequireShown(reading, plan_.bench);
  const std::vector<Reading>& before = taken_.empty() ? state_.kept : taken_;
  if (!before.empty()) RequireTogether(reading, before.back(), plan_.bench);
  if (!before.empty() && options_.require_goes_along) options_.require_goes_along(reading, before.back());
  if (options_.require_no_jump) options_.require_no_jump(reading, state_.kept);
  const double room_degC = reading.temperature_degC;
  if (room_degC < options_.coldest_degC || room_degC > options_.hottest_degC)
    throw DeviceFault(FaultKind::kImplausible, "thermometer",
                      fmt::format("{:.4g} degC; no bench is measured in such a room", room_degC));
  if (static_cast<std::size_t>(number) < state_.kept.size()) {
    if (bench_.simulation) {
      RequireSame(reading);
      if (static_cast<std::size_t>(number) + 1 == state_.kept.size()) bench_.simulation->SetPaced(true);
    } else {
      options_.require_as_before(reading, state_.kept.back());
      state_.is_doubted = false;
    }
    return;
  }
  state_.is_doubted = false;
  taken_.push_back(reading);
  if (taken_.size() >= Together() || IsLast(number)) Flush();
}

void MachineSequencer::KeepAndHear(int number, const Reading& sample, const std::function<void(Reading&)>& enter) {
  Keep(number, sample, enter);
  if (!IsLast(number)) HearOperator(options_);
}

std::size_t MachineSequencer::Together() const {
  if (!options_.log) return kTogetherAlone;
  return bench_.simulation ? kTogetherWatched : 1;
}

void MachineSequencer::Flush() {
  if (taken_.empty()) return;
  sink_.AppendAll(taken_);
  state_.kept.insert(state_.kept.end(), taken_.begin(), taken_.end());
  taken_.clear();
  const Reading& last = state_.kept.back();
  if (progress_)
    progress_({static_cast<int>(state_.kept.size()), static_cast<int>(plan().size()), last.phase, last.time});
}

/// A simulation that shows something else is not the one that made the record.
void MachineSequencer::RequireSame(const Reading& reading) const {
  const Reading& before = state_.kept[static_cast<std::size_t>(reading.reading)];
  for (const ReadingColumn& column : FormatOf(plan_.bench).columns) {
    if (column.print(reading) == column.print(before)) continue;
    throw InputError("record",
                     fmt::format("reading {} has {} = {} now and {} in the record", reading.reading, column.name,
                                 column.print(reading), column.print(before)),
                     "the bench, scenario, seed and version that made the record");
  }
}

namespace {

/// How a resumed run finds a real bench: as the last reading left it.
MachineRunState StateBehind(const MachineBench& bench, const MachineOptions& options) {
  MachineRunState state{options.kept, {}};
  if (!bench.simulation && !options.kept.empty()) state.mounted = options.kept.back().setup;
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
    throw DeviceFault(FaultKind::kRefused, "machine",
                      "has lost its origin with an instrument mounted: take it off, find the origins, put it back and go on with "
                      "--resume");
  if (!options.may_home)
    throw DeviceFault(FaultKind::kRefused, "machine",
                      "has lost its origin, and finding it moves the machine: look whether it may, then agree with "
                      "--allow-homing");
  bench.machine.Home();
  if (options.log) options.log->AppendEvent(bench.clock.Now(), "machine", "has found its origin again");
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
      return sequencer.Flush();
    } catch (const DeviceFault& fault) {
      if (options.hear_fault) options.hear_fault(fault);
      const Standstill stands = StopMachine(bench, options);
      sequencer.Flush();
      if (options.log) options.log->ForgetCalls();
      const int next = static_cast<int>(state.kept.size());
      NoteFailure(options.log, next, TimeOf(bench, state), fault);
      if (!options.log || !stands.is_sure || !IsWorthAnotherAttempt(fault.kind()) || IsBeyondProof(fault, state, options) ||
          !attempts.AnotherAt(next))
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
