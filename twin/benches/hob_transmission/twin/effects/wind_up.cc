#include <cmath>

#include "twin/benches/hob_transmission/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The table stays behind; after a reversal the lag goes over to the other sense exponentially with the way
/// travelled. A run starts without any.
class WindUp : public HobEffect {
 public:
  explicit WindUp(const EffectSettings& e)
      : lag_rad_(Parameter(e, "lag")), settles_over_rad_(Parameter(e, "settles_over")) {}
  void Travel(double table_rad) override {
    const double way_rad = table_rad - last_rad_;
    last_rad_ = table_rad;
    if (way_rad == 0.0) return;
    const double sense = way_rad > 0.0 ? 1.0 : -1.0;
    state_ = sense + (state_ - sense) * std::exp(-std::abs(way_rad) / settles_over_rad_);
  }
  ShownError Shown(const HobMoment&) override { return {.motion_rad = -lag_rad_ * state_}; }

 private:
  double lag_rad_, settles_over_rad_;
  double last_rad_ = 0.0;
  double state_ = 0.0;  // -1 to 1
};

}  // namespace

HobEffectPointer MakeWindUp(const EffectSettings& effect) {
  return std::make_unique<WindUp>(effect);
}

}  // namespace twinbench::sim
