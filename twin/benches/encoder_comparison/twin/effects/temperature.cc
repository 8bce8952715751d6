#include "twin/benches/encoder_comparison/twin/effects/effects.h"
#include "twin/model/first_order_lag.h"

namespace twinbench::sim {
namespace {

/// The device's zero follows the temperature of the room, or one that lags behind it.
class ZeroTemperature : public AngleEffect {
 public:
  explicit ZeroTemperature(const EffectSettings& e)
      : rad_per_K_(Parameter(e, "coefficient")), followed_(Parameter(e, "lag")) {}
  void Advance(const AngleMoment& moment) override {
    above_K_ = followed_.Next(ToSeconds(moment.now), moment.above_K);
  }
  double DeviceError_rad(const AngleMoment&, double) const override { return rad_per_K_ * above_K_; }

 private:
  double rad_per_K_;
  model::FirstOrderLag followed_;
  double above_K_ = 0.0;
};

}  // namespace

AngleEffectPointer MakeZeroTemperature(const EffectSettings& settings) {
  return std::make_unique<ZeroTemperature>(settings);
}

}  // namespace twinbench::sim
