#include "tools/twinbench/machine_rehearsal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/proof_by_steps.h"
#include "twin/benches/registry.h"
#include "twin/procedure/machine_options.h"

namespace twinbench::tools {
namespace {

/// A machine, and how far its axes are sent.
class TravelWatch : public MachineController {
 public:
  TravelWatch(MachineController& machine, std::vector<AxisLimits>& travel) : machine_(machine), travel_(travel) {
    for (const AxisState& axis : machine_.State())
      travel_.push_back({.lower = axis.encoder, .upper = axis.encoder});
  }
  const std::vector<MachineAxis>& Axes() const override { return machine_.Axes(); }
  std::vector<AxisLimits> Travel() override { return machine_.Travel(); }
  void StartMove(const std::vector<double>& to, double feed_m_s) override {
    for (std::size_t k = 0; k < to.size(); ++k) Note(k, to[k]);
    machine_.StartMove(to, feed_m_s);
  }
  /// The whole circle: where it begins and ends does not matter to somebody who looks for a collision.
  void StartArc(const Arc& arc) override {
    const std::vector<AxisState> states = machine_.State();
    const auto [i, j] = arc.axes;
    const double radius_m = std::hypot(states[i].encoder - arc.centre_m[0], states[j].encoder - arc.centre_m[1]);
    for (std::size_t side = 0; side < 2; ++side) {
      Note(arc.axes[side], arc.centre_m[side] - radius_m);
      Note(arc.axes[side], arc.centre_m[side] + radius_m);
    }
    machine_.StartArc(arc);
  }
  void StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) override {
    machine_.StartTurning(axis, speed_rad_s, ramp);
    turning_ = true;
  }
  bool Settles(Duration within) override { return machine_.Settles(within); }
  /// How far an axis comes that turns on and on is seen where it is looked at.
  std::vector<AxisState> State() override {
    std::vector<AxisState> states = machine_.State();
    for (std::size_t k = 0; turning_ && k < states.size(); ++k) Note(k, states[k].encoder);
    return states;
  }
  void Stop() override { machine_.Stop(); }
  void Home() override { machine_.Home(); }

 private:
  void Note(std::size_t axis, double at) {
    travel_[axis].lower = std::min(travel_[axis].lower, at);
    travel_[axis].upper = std::max(travel_[axis].upper, at);
  }

  MachineController& machine_;
  std::vector<AxisLimits>& travel_;
  bool turning_ = false;
};

class ReadingCount : public ReadingSink {
 public:
  explicit ReadingCount(MachineRehearsal& r) : r_(r) {}
  void Append(const Reading& reading, const Acquisition&) override {
    ++r_.readings;
    if (reading.status != ReadingStatus::kOk) ++r_.without_numbers;
  }

 private:
  MachineRehearsal& r_;
};

std::string FromTo(const MachineAxis& axis, const AxisLimits& limits) {
  return fmt::format("{:.3f} to {:.3f} {}", limits.lower / axis.to_SI(), limits.upper / axis.to_SI(), axis.unit());
}

constexpr double kRounding = 1e-9;  // m or rad: no machine tells it apart

void JudgeTravel(const std::vector<MachineAxis>& axes, const std::vector<AxisLimits>& limits, MachineRehearsal& r) {
  for (std::size_t k = 0; k < axes.size(); ++k) {
    if (r.travel[k].lower >= limits[k].lower - kRounding && r.travel[k].upper <= limits[k].upper + kRounding)
      continue;
    r.problems.push_back(fmt::format("axis {} would travel from {}; its limits are {}", axes[k].name,
                                     FromTo(axes[k], r.travel[k]), FromTo(axes[k], limits[k])));
  }
}

}  // namespace

MachineRehearsal RehearseMachine(const Scenario& scenario, const std::vector<AxisLimits>& limits, bool is_real) {
  const Bench& bench = BenchOf(scenario);
  MachineRehearsal rehearsal;
  const auto twin = bench.make_devices(scenario);
  MachineBench inner = twin->Devices();
  TravelWatch machine(inner.machine, rehearsal.travel);
  MachineBench watched{inner.clock, machine, inner.instruments, inner.fixture, inner.simulation, inner.indexer};
  ReadingCount count(rehearsal);
  procedure::MachineOptions options;
  if (is_real) options.prove = WayOf(ProofBySteps(inner, scenario, options));  // which keeps within limits by themselves
  bench.drive(watched, scenario, count, {}, options);
  rehearsal.duration_s = ToSeconds(inner.clock.Now());
  JudgeTravel(inner.machine.Axes(), limits, rehearsal);
  if (rehearsal.without_numbers > 0)
    rehearsal.problems.push_back(
        fmt::format("{} of {} readings would have no numbers", rehearsal.without_numbers, rehearsal.readings));
  return rehearsal;
}

std::string Summary(const MachineRehearsal& r, const std::vector<MachineAxis>& axes,
                    const std::vector<AxisLimits>& limits) {
  const long minutes = std::lround(r.duration_s / 60.0);
  std::string text =
      fmt::format("rehearsal by simulation: {} readings, {} h {:02} min\n", r.readings, minutes / 60, minutes % 60);
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const bool limited = std::isfinite(limits[k].lower) && std::isfinite(limits[k].upper);
    text += fmt::format("  axis {:<4} {:<34}{}\n", axes[k].name, FromTo(axes[k], r.travel[k]),
                        limited ? "limits " + FromTo(axes[k], limits[k]) : "no limits");
  }
  for (const std::string& problem : r.problems) text += "  PROBLEM: " + problem + "\n";
  return text;
}

nlohmann::json RehearsalJson(const MachineRehearsal& r, const std::vector<MachineAxis>& axes) {
  nlohmann::json travel = nlohmann::json::object();
  for (std::size_t k = 0; k < axes.size(); ++k)
    travel[axes[k].name + "_" + axes[k].unit()] = {r.travel[k].lower / axes[k].to_SI(), r.travel[k].upper / axes[k].to_SI()};
  return {{"rehearsal",
           {{"readings", r.readings},
            {"without_numbers", r.without_numbers},
            {"duration_s", r.duration_s},
            {"travel", travel},
            {"problems", r.problems}}}};
}

}  // namespace twinbench::tools
