#include "mechanics/adaptive_stack.h"
#include "mechanics/drives.h"
#include "mechanics/sag.h"

namespace twinbench::mechanics {
namespace {

class BulletPlant : public DrivenPlant {
 public:
  explicit BulletPlant(const StackParameters& p) : DrivenPlant(p), stack_(p, StaticDeflection(p, 0.0, 0.0)) {}

 private:
  void Step(Nanoseconds time) override {
    stack_.Step(time, commands());
    for (int t = 0; t < 2; ++t) deviation_rad_[t] = stack_.Spin_rad(t) - Commanded_rad(t, time + period());
  }

  void Prepare(Nanoseconds time) override { stack_.Prepare(time, commands()); }

  Vector12 Coordinates(Nanoseconds time, Nanoseconds since) const override {
    Vector12 q = stack_.Coordinates(ToSeconds(since));
    for (int t = 0; t < 2; ++t) q[SpinIndex(t)] -= Commanded_rad(t, time + since);
    return q;
  }

  Eigen::Vector2d Deviation_rad() const override { return deviation_rad_; }
  std::array<BearingPose, 2> Bearings(const Vector12& q, double, double) const override {
    return {BearingOf(q, 0), BearingOf(q, 1)};
  }

  bool CanRest() const override { return stack_.CanRest(); }
  void Rest(std::int64_t periods) override {
    stack_.Rest(periods, {commands().profile(0).to_rad(), commands().profile(1).to_rad()});
  }

  void OnStart() override { stack_.Replan(); }
  void OnWake(Nanoseconds since) override { stack_.Wake(ToSeconds(since)); }
  void OnMount() override { stack_.Mount(parameters()); }

  double Commanded_rad(int table, Nanoseconds time) const {
    return commands().At(static_cast<std::size_t>(table), time).position_rad;
  }

  AdaptiveStack stack_;
  Eigen::Vector2d deviation_rad_ = Eigen::Vector2d::Zero();
};

}  // namespace

std::unique_ptr<Plant> MakeBulletPlant(const StackParameters& parameters) {
  if (parameters.integrator != Integrator::kAdaptive) return MakeFixedStepPlant(parameters);
  return std::make_unique<BulletPlant>(parameters);
}

}  // namespace twinbench::mechanics
