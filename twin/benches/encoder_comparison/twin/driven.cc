#include "twin/benches/encoder_comparison/twin/twin.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/procedure.h"
#include "twin/core/happened_once.h"

namespace twinbench::sim {
namespace {

constexpr double kSameAngle_rad = 1e-9;
constexpr Duration kSameTime{2};     // both are rounded
constexpr double kRounded_s = 1e-7;  // of all times of a run's sweeps together
constexpr int kBesideThePlan = -1;   // a pass
constexpr double kSlowest_rad_s = 30.0 * units::deg;

class ShaftPhysics : public DrivenPhysics {
 public:
  explicit ShaftPhysics(const Scenario& scenario)
      : begun_(scenario), scenario_(scenario), plan_(procedure::AngleSchedule(settings().encoder_procedure)) {
    Restart();
  }

  const std::vector<MachineAxis>& Axes() const override { return axes_; }
  int Setups() const override { return static_cast<int>(settings().encoder_procedure.mounting_rad.size()); }

  /// A turn beyond the plan.
  std::vector<AxisLimits> Travel() const override {
    const auto [least, most] = std::ranges::minmax_element(plan_, {}, &Reading::reference_rad);
    return {{.lower = least->reference_rad - units::turn, .upper = most->reference_rad + units::turn}};
  }

  std::vector<double> Start() const override { return {plan_.front().reference_rad}; }

  /// Four times as fast as the plan needs: it leaves no time for the ways between passes.
  double Traverse_rad_s() const override {
    constexpr double kEasily = 4.0;
    const double run_up_rad = units::turn / settings().encoder_procedure.stops;
    double speed_rad_s = kSlowest_rad_s;
    for (std::size_t k = 1; k < plan_.size(); ++k) {
      const double time_s = ToSeconds(plan_[k].time - plan_[k - 1].time);
      const double way_rad = std::abs(plan_[k].reference_rad - plan_[k - 1].reference_rad) + run_up_rad;
      if (time_s > 0.0) speed_rad_s = std::max(speed_rad_s, kEasily * way_rad / time_s);
    }
    return speed_rad_s;
  }

  bool TurnsOn() const override { return settings().encoder_procedure.kind == "sweep"; }

  std::optional<Time> Planned(const DrivenInstant& at) const override {
    if (at.sample >= static_cast<int>(plan_.size())) return std::nullopt;
    const Reading& planned = plan_[static_cast<std::size_t>(at.sample)];
    const bool same = planned.setup / Heads() == at.setup &&
                      std::abs(planned.reference_rad - at.commanded[0]) < SameAngle_rad();
    return same ? std::optional(planned.time) : std::nullopt;
  }

  Reading Show(const DrivenInstant& at) override {
    const std::optional<Time> planned = Planned(at);
    const bool as_planned = planned && std::chrono::abs(*planned - at.time) <= kSameTime;
    Reading shown = as_planned ? plan_[static_cast<std::size_t>(at.sample)] : Beside(at);
    twin_->Take(shown);
    return shown;
  }

  void Restart() override { twin_ = std::make_unique<EncoderTwin>(scenario_); }
  void BeRun(int repeat) override { scenario_ = InRun(begun_, repeat); }

 private:
  const EncoderSettings& settings() const { return EncoderOf(scenario_); }
  int Heads() const { return static_cast<int>(settings().encoder_procedure.heads_rad.size()); }

  double SameAngle_rad() const {
    return TurnsOn() ? kSameAngle_rad + kRounded_s * std::ranges::max(settings().encoder_procedure.speeds_rad_s) : kSameAngle_rad;
  }

  /// By the first head, come from below.
  Reading Beside(const DrivenInstant& at) const {
    Reading r;
    r.reading = at.sample;
    r.time = at.time;
    r.setup = at.setup * Heads();
    r.pass = kBesideThePlan;
    r.reference_rad = at.commanded[0];
    r.velocity_rad_s = at.turning_rad_s;
    return r;
  }

  Scenario begun_, scenario_;  // as it was made, and in its present run
  std::vector<Reading> plan_;
  std::unique_ptr<EncoderTwin> twin_;
  std::vector<MachineAxis> axes_ = {{"shaft", true}};
};

}  // namespace

std::unique_ptr<DrivenPhysics> MakeShaftPhysics(const Scenario& scenario) {
  return std::make_unique<ShaftPhysics>(scenario);
}

}  // namespace twinbench::sim
