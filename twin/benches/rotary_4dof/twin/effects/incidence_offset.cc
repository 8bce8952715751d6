#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The laser stands aside and still hits the nominal spot: the light comes in at an angle in the plane of
/// dispersion, positive when it comes from +x.
class IncidenceOffset : public Effect {
 public:
  explicit IncidenceOffset(const EffectSettings& e) : incidence_rad_(Parameter(e, "incidence")) {}
  void AlterBench(Scenario& actual) const override {
    const Vector3 from_spot_m = RotaryOf(actual).laser.position_m;
    RotaryOf(actual).laser.position_m = Eigen::AngleAxisd(-incidence_rad_, Vector3::UnitZ()) * from_spot_m;
    RotaryOf(actual).laser.yaw_rad -= incidence_rad_;
  }

 private:
  double incidence_rad_;
};

}  // namespace

EffectPointer MakeIncidenceOffset(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<IncidenceOffset>(settings);
}

}  // namespace twinbench::sim
