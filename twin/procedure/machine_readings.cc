#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/bench_format.h"
#include "twin/core/device_fault.h"
#include "twin/procedure/machine_sequencer.h"
#include "twin/procedure/machine_watch.h"
#include "twin/procedure/plausible.h"

namespace twinbench::procedure {
namespace {

/// The plan counts in nanoseconds that are rounded; so much later is in time.
constexpr Duration kInTime = std::chrono::microseconds(1);

/// A run on a real bench keeps what it has at once; simulated readings come too fast to be waited for one by one.
constexpr std::size_t kTogetherWatched = 32, kTogetherAlone = 256;

}  // namespace

void MachineSequencer::TakeInMotion(int reading, Time due, Duration late,
                                    const std::function<void(Reading&)>& enter) {
  PauseUntil(due);
  const Time asked = Now();
  const Reading sample = bench_.instruments.Read();
  const Time now = Now();
  RequireTimely(sample, asked, now);
  if (now > due + late)
    throw DeviceFault(
        FaultKind::kOverrun, "instruments",
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
  const bool goes_on = first > 0 && !state_.kept.empty() &&
                       plan()[static_cast<std::size_t>(first)].pass == state_.kept.back().pass &&
                       plan()[static_cast<std::size_t>(first)].setup == state_.kept.back().setup;
  std::optional<Reading> before = goes_on ? std::optional(state_.kept.back()) : std::nullopt;
  double step_rad = kNaN;  // from the first sample to the second
  // From before a fault to behind it whole turns may be lost, so that a wrong sample passes alone: those of one
  // look come together.
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
      if (next > first && !IsSimulated()) RequireNextLine(sample, *before, plan_.bench, lines, step_rad);
      before = sample;
      if (next == end)
        throw DeviceFault(FaultKind::kProtocol, "instruments", "more samples came than they were armed for");
      KeepAndHear(next++, sample);
    }
    if (latched.overrun)
      throw DeviceFault(
          FaultKind::kOverrun, "instruments",
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
    if (states[k].moving)
      throw DeviceFault(FaultKind::kMoved, axes()[k].name, "moves while it is read, as its controller says");
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
    if (IsOfInstruments(column) && !column.print(sample).empty()) column.number(joined) = column.number(shown);
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

}  // namespace twinbench::procedure
