#include <optional>
#include <stdexcept>

#include "mechanics/drive_loads.h"
#include "mechanics/drives.h"
#include "mechanics/sag.h"

namespace twinbench::mechanics {
namespace {

class KinematicPlant : public Plant {
 public:
  explicit KinematicPlant(const StackParameters& parameters)
      : parameters_((Check(parameters), parameters)),
        backlash_{Backlash(parameters.table[0].backlash_rad), Backlash(parameters.table[1].backlash_rad)},
        loaded_(HasLoads(parameters)) {
    Mount(parameters.geometry);
  }

  void StartMove(Axis axis, double to_rad, double duration_s) override {
    commands_.Start(axis, to_rad, duration_s, now_);
  }

  void Stop(Axis axis) override { commands_.Stop(axis, kBraking_s, now_); }
  double CommandedEnd_rad(Axis axis) const override { return commands_.profile(Index(axis)).to_rad(); }

  void Advance(double dt_s) override {
    now_ += ToNanoseconds(dt_s);
    for (std::size_t i = 0; i < 2; ++i) backlash_[i].Follow(Shaft_rad(i));
  }

  using Plant::Settled;
  bool Settled(Axis axis) const override { return commands_.Ended(Index(axis), now_); }

  StackState State() const override {
    StackState state;
    state.target_rad = backlash_[0].rotor_rad();
    state.reference_rad = backlash_[1].rotor_rad();
    state.target_encoder_rad = commands_.At(0, now_).position_rad;
    state.reference_encoder_rad = commands_.At(1, now_).position_rad;
    Vector12 q =
        constant_sag_ ? *constant_sag_ : StaticDeflection(parameters_, state.target_rad, state.reference_rad);
    if (loaded_) q += Yielded();
    state.target_bearing = BearingOf(q, 0);
    state.reference_bearing = BearingOf(q, 1);
    return state;
  }

  void Mount(const ChainGeometry& geometry) override {
    if (!Settled()) throw std::logic_error("plant: mounting needs tables at rest");
    parameters_.geometry = geometry;
    constant_sag_.reset();
    if (SagIsConstant(parameters_)) constant_sag_ = StaticDeflection(parameters_, 0.0, 0.0);
  }

 private:
  /// A servo without error stands where its scale shows the command.
  double Shaft_rad(std::size_t table) const {
    const double command_rad = commands_.At(table, now_).position_rad;
    const ScaleParameters& scale = parameters_.table[table].scale;
    return scale.subdivision_rad == 0.0 ? command_rad : AngleShowing_rad(scale, command_rad);
  }

  /// By which the bearings give way to unbalance, each on its own spring.
  Vector12 Yielded() const {
    const ProfilePoint target = commands_.At(0, now_), reference = commands_.At(1, now_);
    const Vector12 load = DriveLoads(parameters_, {target.position_rad, reference.position_rad},
                                     {target.velocity_rad_s, reference.velocity_rad_s});
    const Vector12 stiffness = BearingStiffness(parameters_);
    return (stiffness.array() > 0.0).select(load.cwiseQuotient(stiffness), 0.0);
  }

  double ProfileLeft_s() const override { return commands_.Left_s(now_); }

  StackParameters parameters_;
  Commands commands_;
  std::array<Backlash, 2> backlash_;
  std::optional<Vector12> constant_sag_;
  bool loaded_;
  Nanoseconds now_ = 0;
};

}  // namespace

std::unique_ptr<Plant> MakeKinematicPlant(const StackParameters& parameters) {
  return std::make_unique<KinematicPlant>(parameters);
}

}  // namespace twinbench::mechanics
