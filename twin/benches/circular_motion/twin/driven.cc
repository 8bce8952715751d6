#include "twin/benches/circular_motion/twin/live.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "twin/benches/circular_motion/twin/beside.h"
#include "twin/core/happened_once.h"

namespace twinbench::sim {
namespace {

using namespace benches::circular;

constexpr double kSame_m = 1.0 * units::nm, kSameFeed = 1e-9;
constexpr Duration kSameTime{2};     // both are rounded
constexpr double kRoomToMove = 1.1;  // of the largest radius

class CirclePhysics : public DrivenPhysics {
 public:
  explicit CirclePhysics(const Scenario& scenario)
      : scenario_(scenario), repeat_(scenario.repeat), run_(scenario), settings_(CircularOf(scenario)) {}

  const std::vector<MachineAxis>& Axes() const override { return axes_; }
  int Setups() const override { return static_cast<int>(settings_.procedure.setups.size()); }

  std::vector<AxisLimits> Travel() const override {
    double half_m = settings_.machine.span_m;
    for (const CircularSetup& setup : settings_.procedure.setups)
      half_m = std::max(half_m, kRoomToMove * setup.radius_m);
    return {2, AxisLimits{.lower = -half_m, .upper = half_m}};
  }

  std::vector<double> Start() const override {
    const Reading& first = run_->Planned(0);
    return {kCommandedX_m(first), kCommandedY_m(first)};
  }

  std::optional<Time> Planned(const DrivenInstant& at) const override {
    if (at.sample >= run_->Readings()) return std::nullopt;
    const Reading& planned = run_->Planned(at.sample);
    const double off_m =
        std::hypot(kCommandedX_m(planned) - at.commanded[0], kCommandedY_m(planned) - at.commanded[1]);
    const bool same = planned.setup == at.setup && planned.direction == at.direction && off_m < kSame_m &&
                      std::abs(kFeed_m_s(planned) - at.feed_m_s) <= kSameFeed * at.feed_m_s;
    return same ? std::optional(planned.time) : std::nullopt;
  }

  Reading Show(const DrivenInstant& at) override {
    const std::optional<Time> planned = Planned(at);
    const bool as_planned = planned && std::chrono::abs(*planned - at.time) <= kSameTime;
    const Reading shown = as_planned ? AsPlanned(at.sample) : Beside(Commanded(at));
    course_.push_back(shown);
    return shown;
  }

  void Restart() override {
    beside_.reset();
    course_.clear();
  }
  void BeRun(int repeat) override {
    if (repeat == repeat_) return;
    beside_.reset();
    run_.emplace(InRun(scenario_, repeat));
    repeat_ = repeat;
  }

 private:
  Reading AsPlanned(int sample) {
    beside_.reset();
    return run_->Take(sample);
  }
  Reading Beside(const Reading& commanded) {
    if (!beside_) beside_.emplace(*run_, course_);
    return beside_->Take(commanded);
  }

  static Reading Commanded(const DrivenInstant& at) {
    Reading r;
    r.reading = at.sample;
    r.time = at.time;
    r.setup = at.setup;
    r.direction = at.direction;
    kCommandedX_m(r) = at.commanded[0];
    kCommandedY_m(r) = at.commanded[1];
    kFeed_m_s(r) = at.feed_m_s;
    return r;
  }

  Scenario scenario_;
  int repeat_;  // of run_
  std::optional<CircleRun> run_;
  CircularSettings settings_;
  std::vector<MachineAxis> axes_ = {{"x"}, {"y"}};
  std::vector<Reading> course_;  // what was taken
  std::optional<CircleBeside> beside_;
};

}  // namespace

std::unique_ptr<DrivenPhysics> MakeCirclePhysics(const Scenario& scenario) {
  return std::make_unique<CirclePhysics>(scenario);
}

}  // namespace twinbench::sim
