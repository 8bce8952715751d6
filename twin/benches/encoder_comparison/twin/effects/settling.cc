#include <cmath>

#include "twin/benches/encoder_comparison/twin/effects/effects.h"
#include "twin/core/units.h"

namespace twinbench::sim {
namespace {

/// Wound-up parts, a drive that creeps: behind by the same after every move, in its sense, and relaxing at rest.
class Settling : public AngleEffect {
 public:
  explicit Settling(const EffectSettings& e)
      : amplitude_rad_(Parameter(e, "amplitude")), time_constant_s_(Parameter(e, "time_constant")) {}
  void Advance(const AngleMoment& moment) override {
    constexpr double kStands_rad = 1e-3 * units::deg;  // a reference at rest moves by its noise
    const double way_rad = moment.shaft_rad - last_.shaft_rad;
    const bool came_back = moment.approach_rad * last_.approach_rad < 0.0;  // to the same stop
    if (!started_ || came_back || std::abs(way_rad) > kStands_rad) {
      state_ = Sense(moment.approach_rad != 0.0 ? moment.approach_rad : started_ ? way_rad : 0.0);
    } else {
      state_ *= std::exp(-ToSeconds(moment.now - last_.now) / time_constant_s_);
    }
    last_ = moment;
    started_ = true;
  }
  double ShaftError_rad(const AngleMoment&) const override { return -amplitude_rad_ * state_; }

 private:
  static double Sense(double way_rad) { return way_rad > 0.0 ? 1.0 : way_rad < 0.0 ? -1.0 : 0.0; }

  double amplitude_rad_, time_constant_s_;
  double state_ = 0.0;  // of what a move leaves, with its sense
  AngleMoment last_;
  bool started_ = false;
};

}  // namespace

AngleEffectPointer MakeSettling(const EffectSettings& settings) {
  return std::make_unique<Settling>(settings);
}

}  // namespace twinbench::sim
