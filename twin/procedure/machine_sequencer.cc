#include "twin/procedure/machine_sequencer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/device_fault.h"
#include "twin/procedure/machine_watch.h"

namespace twinbench::procedure {
namespace {

constexpr double kTraverseAtLeast_m_s = 1e-3, kTurnAtLeast_rad_s = 1.0 * units::deg;

}  // namespace

bool CanProve(const MachineRunState& state, const MachineOptions& options) {
  if (!options.require_as_before || state.kept.empty()) return false;
  return state.mounted == state.kept.back().setup && WasAtRest(state.kept.back());
}

MachineSequencer::MachineSequencer(MachineBench bench, const MachinePlan& plan, ReadingSink& sink,
                                   const MachineOptions& options, const ProgressCallback& progress,
                                   MachineRunState& state)
    : bench_(bench),
      plan_(plan),
      sink_(sink),
      options_(options),
      progress_(progress),
      state_(state),
      where_(bench_.machine.Axes(), options.axes) {}

std::vector<double> MachineSequencer::Where() {
  std::vector<double> at;
  for (const AxisState& axis : bench_.machine.State()) at.push_back(axis.encoder);
  return at;
}

std::vector<double> MachineSequencer::WhereSent() {
  std::vector<double> at;
  for (const AxisState& axis : bench_.machine.State())
    at.push_back(std::isnan(axis.commanded) ? axis.encoder : axis.commanded);
  return at;
}

int MachineSequencer::From(int first, int end) const {
  return bench_.simulation ? first
                           : std::clamp(static_cast<int>(state_.kept.size()) -
                                            (state_.is_doubted && CanProve(state_, options_) ? 1 : 0),
                                        first, end);
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
    takes_s +=
        std::abs(to[k] - from[k].encoder) / (axes()[k].is_rotary ? kTurnAtLeast_rad_s : kTraverseAtLeast_m_s);
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
  Watch(bench_, PathTime_s(arc, RadiusNow_m(arc, from)), where_, options_);
}

void MachineSequencer::Sweep(const Arc& arc, int first, int end, const Reading& stands) {
  const std::vector<Reading> samples = SamplesAlong(arc, static_cast<std::size_t>(end - first));
  if (options_.prove) options_.prove(stands);
  for (const Reading& sample : samples) Keep(first++, sample);
}

/// All of them or none: behind a trigger that latched nothing every sample would stand one place too early.
std::vector<Reading> MachineSequencer::SamplesAlong(const Arc& arc, std::size_t triggers) {
  HearOperator(options_);
  if (options_.log) options_.log->RequireRoom();
  const std::vector<AxisState> from = LookBeforeMotion();
  const double radius_m = RadiusNow_m(arc, from);
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
                      fmt::format("the path has ended and {} of {} triggers latched nothing",
                                  triggers - samples.size(), triggers));
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
                      fmt::format("took {:.3g} s from the first trigger to the {}th and takes {:.3g} s at its feed "
                                  "of {:.6g} mm/min: is an "
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

}  // namespace twinbench::procedure
