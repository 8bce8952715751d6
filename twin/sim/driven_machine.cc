#include "twin/sim/driven_machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/device_fault.h"
#include "twin/core/numbered_runs.h"
#include "twin/sim/driven_path.h"
#include "twin/sim/schedule.h"
#include "twin/sim/setup_check.h"

namespace twinbench::sim {
namespace {

constexpr double kTraverse_m_s = 0.2;
constexpr Duration kHoming = std::chrono::seconds(10), kBrake = std::chrono::seconds(1);

Duration MoveTime(const std::vector<double>& from, const std::vector<double>& to, double feed_m_s,
                  const std::vector<MachineAxis>& axes, double traverse_rad_s) {
  double square_m2 = 0.0, turn_rad = 0.0;
  for (std::size_t k = 0; k < to.size(); ++k) {
    const double way = to[k] - from[k];
    if (axes[k].is_rotary) {
      turn_rad = std::max(turn_rad, std::abs(way));
    } else {
      square_m2 += way * way;
    }
  }
  const double speed_m_s = feed_m_s > 0.0 ? feed_m_s : kTraverse_m_s;
  return FromSeconds(std::max(std::sqrt(square_m2) / speed_m_s, turn_rad / traverse_rad_s));
}

}  // namespace

/// The machine's clock and what each device has to do with it. Goes anew where the machine is restarted.
struct DrivenKernel {
  EventQueue queue;
  Schedule axes{queue, "axes"}, instruments{queue, "instruments"}, fixture{queue, "fixture"};
};

struct DrivenMachine::Parts : Clock, MachineController, InstrumentSet, MachineFixture, Simulation, NumberedRuns {
  explicit Parts(std::unique_ptr<DrivenPhysics> its_physics)
      : physics(std::move(its_physics)), travel(physics->Travel()) {
    Begin();
  }

  // Clock
  Time Now() const override { return kernel->queue.Now(); }
  void Wait(Duration duration) override { kernel->queue.RunUntil(Now() + duration); }

  // Controller
  const std::vector<MachineAxis>& Axes() const override { return physics->Axes(); }
  std::vector<AxisLimits> Travel() override { return travel; }

  void StartMove(const std::vector<double>& to, double its_feed_m_s) override {
    Require(to.size() == Axes().size(), "a move has one coordinate an axis");
    RequireWithinTravel(to);
    const std::vector<double> from = path.At(Now());
    kernel->axes.Now([&] {
      BeginPath(DrivenPath::Line(from, to, Now(), MoveTime(from, to, its_feed_m_s, Axes(), physics->Traverse_rad_s())),
                its_feed_m_s, 1);
    });
  }

  void StartArc(const Arc& arc) override {
    const std::vector<double> from = path.At(Now());
    RequireArc(arc, from);
    kernel->axes.Now([&] { BeginArc(arc, from); });
  }

  void StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) override {
    if (!physics->TurnsOn()) return MachineController::StartTurning(axis, speed_rad_s, ramp);
    if (!std::isfinite(speed_rad_s) || ramp <= Duration(0))
      throw DeviceFault(FaultKind::kRefused, Axes()[0].name, "no speed, or no time to go over to it");
    kernel->axes.Now([&] { TurnTo(speed_rad_s, ramp); });
  }

  bool Settles(Duration within) override {
    kernel->axes.RunUntil(std::min(Now() + within, std::max(Now(), path.End())), [] {});
    return Now() >= path.End();
  }

  std::vector<AxisState> State() override {
    const std::vector<double> at = path.At(Now());
    const bool moves = Now() < path.End();
    std::vector<AxisState> states(at.size());
    for (std::size_t k = 0; k < at.size(); ++k) {
      states[k].commanded = path.to()[k];
      states[k].encoder = at[k];
      states[k].moving = moves;
      states[k].in_position = !moves;
    }
    return states;
  }

  void Stop() override {
    kernel->axes.Now([this] {
      if (path.TurningSpeed_rad_s(Now()) != 0.0) return TurnTo(0.0, kBrake);
      BeginPath(DrivenPath::Resting(path.At(Now()), Now()), feed_m_s, direction);
    });
  }

  void Home() override {
    Stop();
    Wait(kHoming);
  }

  // Instruments
  Reading Read() override {
    Reading shown;
    kernel->instruments.Now([&] {
      const double now_feed_m_s = Now() < path.End() ? feed_m_s : 0.0;
      shown = Show({next_sample, Now(), setup, direction, now_feed_m_s, path.At(Now()), path.TurningSpeed_rad_s(Now())});
    });
    return shown;
  }
  void Arm(int samples, int lines) override {
    if (lines > 0)
      throw DeviceFault(FaultKind::kRefused, "instruments", "they latch at the machine's triggers, not at lines");
    latched = {};
    armed = samples;
  }
  LatchedSamples Latched() override { return std::exchange(latched, {}); }

  // Fixture
  void Clear() override {}
  void Mount(int its_setup, const std::string&) override {
    RequireSetup(its_setup, physics->Setups());
    kernel->fixture.Now([this, its_setup] { setup = its_setup; });
  }

  // Simulation
  void Restart() override {
    physics->Restart();
    Begin();
  }
  void BeRun(int repeat) override { physics->BeRun(repeat); }
  void SetPaced(bool) override {}  // it never is

  void Begin() {
    triggers.clear();  // of the clock that goes
    kernel = std::make_unique<DrivenKernel>();
    setup = next_sample = armed = 0;
    direction = 1;
    feed_m_s = 0.0;
    latched = {};
    path = DrivenPath::Resting(physics->Start(), Now());
  }

  void BeginPath(DrivenPath next, double its_feed_m_s, int its_direction) {
    for (const EventId trigger : std::exchange(triggers, {})) kernel->queue.Cancel(trigger);
    path = std::move(next);
    feed_m_s = its_feed_m_s;
    direction = its_direction;
  }

  void TurnTo(double speed_rad_s, Duration ramp) {
    const DrivenPath next =
        DrivenPath::Turning(path.At(Now())[0], path.TurningSpeed_rad_s(Now()), speed_rad_s, Now(), ramp);
    BeginPath(next, 0.0, speed_rad_s < 0.0 ? -1 : 1);
  }

  Reading Show(const DrivenInstant& at) {
    Reading shown = physics->Show(at);
    shown.time = at.time;
    ++next_sample;
    return shown;
  }

  void BeginArc(const Arc& arc, const std::vector<double>& from) {
    const double radius_m = std::hypot(from[arc.axes[0]] - arc.centre_m[0], from[arc.axes[1]] - arc.centre_m[1]);
    BeginPath(DrivenPath::Circular(from, arc, {{Now(), 1.0}}), arc.feed_m_s, arc.sweep_rad < 0.0 ? -1 : 1);
    const std::vector<PathKnot> knots =
        PlaceTriggers(arc, radius_m / (arc.feed_m_s > 0.0 ? arc.feed_m_s : kTraverse_m_s));
    path = DrivenPath::Circular(from, arc, knots);
  }

  void Latch(DrivenInstant at) {
    if (armed == 0) return;
    --armed;
    at.sample = next_sample;
    latched.samples.push_back(Show(at));
  }

  /// Puts the arc's triggers where and when they come. @return the times of the whole way.
  /// @param s_per_rad  Of the arc.
  std::vector<PathKnot> PlaceTriggers(const Arc& arc, double s_per_rad) {
    const double length_rad = std::abs(arc.sweep_rad);
    std::vector<PathKnot> knots = {{Now(), 0.0}};
    double behind_rad = 0.0;  // the last knot
    for (int k = 0; k < arc.triggers; ++k) {
      const double at_rad = arc.first_trigger_rad + k * arc.trigger_step_rad;
      const double share = at_rad / length_rad;
      DrivenInstant at{next_sample + k, Now(), setup, direction, arc.feed_m_s, path.AtShare(share)};
      const Time first = knots.size() > 1 ? knots[1].time : Now();
      const double from_first_rad = k > 0 ? k * arc.trigger_step_rad : at_rad;
      const auto planned = physics->Planned(at);
      at.time = first + FromSeconds(from_first_rad * s_per_rad);
      if (planned && *planned >= knots.back().time) at.time = *planned;
      knots.push_back({at.time, share});
      triggers.push_back(kernel->instruments.At(at.time, [this, at] { Latch(at); }));
      behind_rad = at_rad;
    }
    knots.push_back({knots.back().time + FromSeconds((length_rad - behind_rad) * s_per_rad), 1.0});
    return knots;
  }

  void RequireArc(const Arc& arc, const std::vector<double>& from) const {
    const auto [i, j] = arc.axes;
    Require(i < from.size() && j < from.size() && i != j, "an arc is of two axes of the machine");
    const double radius_m = std::hypot(from[i] - arc.centre_m[0], from[j] - arc.centre_m[1]);
    const double last_rad = arc.first_trigger_rad + std::max(0, arc.triggers - 1) * arc.trigger_step_rad;
    const bool is_one = radius_m > 0.0 && arc.feed_m_s >= 0.0 && arc.sweep_rad != 0.0 && arc.triggers >= 0 &&
                        arc.first_trigger_rad >= 0.0 && (arc.triggers < 2 || arc.trigger_step_rad > 0.0) &&
                        (arc.triggers == 0 || last_rad <= std::abs(arc.sweep_rad));
    if (!is_one) throw DeviceFault(FaultKind::kRefused, "machine", "this is no arc, or its triggers lie beside it");
    for (std::size_t side = 0; side < 2; ++side) {  // the whole circle must lie within the travel
      std::vector<double> at = from;
      for (const double end : {-radius_m, radius_m}) {
        at[arc.axes[side]] = arc.centre_m[side] + end;
        RequireWithinTravel(at);
      }
    }
  }

  void RequireWithinTravel(const std::vector<double>& to) const {
    for (std::size_t k = 0; k < to.size(); ++k) {
      if (to[k] >= travel[k].lower && to[k] <= travel[k].upper) continue;
      const MachineAxis& axis = Axes()[k];
      throw DeviceFault(FaultKind::kLimit, axis.name,
                        fmt::format("{:.6g} {} lies outside its travel from {:.6g} to {:.6g}", to[k] / axis.to_SI(),
                                    axis.unit(), travel[k].lower / axis.to_SI(), travel[k].upper / axis.to_SI()));
    }
  }

  std::unique_ptr<DrivenPhysics> physics;
  std::vector<AxisLimits> travel;
  std::unique_ptr<DrivenKernel> kernel;
  int setup = 0, next_sample = 0, armed = 0, direction = 1;
  double feed_m_s = 0.0;
  DrivenPath path;
  std::vector<EventId> triggers;  // of the path, those that have come too
  LatchedSamples latched;
};

DrivenMachine::DrivenMachine(std::unique_ptr<DrivenPhysics> physics)
    : parts_(std::make_unique<Parts>(std::move(physics))) {}
DrivenMachine::~DrivenMachine() = default;

MachineBench DrivenMachine::Devices() {
  return {*parts_, *parts_, *parts_, *parts_, parts_.get()};
}

const std::map<std::string, std::uint64_t>& DrivenMachine::Scheduled() const {
  return parts_->kernel->queue.Scheduled();
}

}  // namespace twinbench::sim
