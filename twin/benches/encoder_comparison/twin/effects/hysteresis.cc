#include <cmath>

#include "twin/benches/encoder_comparison/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The reading lags behind the motion; after a reversal the lag goes over to the other sense exponentially with the
/// way travelled.
class Hysteresis : public AngleEffect {
 public:
  explicit Hysteresis(const EffectSettings& e)
      : lag_rad_(Parameter(e, "lag")),
        settles_over_rad_(Parameter(e, "settles_over")),
        approach_(Parameter(e, "approach")),
        state_(Parameter(e, "start")) {}
  void Advance(const AngleMoment& moment) override {
    const double from_rad = moment.shaft_rad - approach_ * moment.approach_rad;
    if (!started_) last_rad_ = from_rad;
    started_ = true;
    Travel(from_rad);
    Travel(moment.shaft_rad);
  }
  double ShaftError_rad(const AngleMoment&) const override { return -lag_rad_ * state_; }

 private:
  void Travel(double to_rad) {
    const double way_rad = to_rad - last_rad_;
    last_rad_ = to_rad;
    if (way_rad == 0.0) return;
    const double sense = way_rad > 0.0 ? 1.0 : -1.0;
    state_ = sense + (state_ - sense) * std::exp(-std::abs(way_rad) / settles_over_rad_);
  }

  double lag_rad_, settles_over_rad_, approach_;
  double state_;  // -1 to 1
  double last_rad_ = 0.0;
  bool started_ = false;
};

}  // namespace

AngleEffectPointer MakeHysteresis(const EffectSettings& settings) {
  return std::make_unique<Hysteresis>(settings);
}

}  // namespace twinbench::sim
