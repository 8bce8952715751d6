#include "twin/benches/turntable_autocollimator/twin/effects/effects.h"
#include "twin/model/product.h"

namespace twinbench::sim {
namespace {

/// A product of an axis of the autocollimator and a course.
class AutocollimatorSignal : public TurntableEffect {
 public:
  AutocollimatorSignal(const EffectSettings& effect, const Scenario& scenario)
      : product_(effect, FormatOf(scenario.bench)) {}

  Eigen::Vector2d ReadingError_rad(const TurntableMoment& moment,
                                   const Eigen::Vector2d& reading_rad) const override {
    const model::Instant instant{.time_s = ToSeconds(moment.now),
                                 .reading = moment.reading,
                                 .direction = static_cast<double>(moment.direction),
                                 .above_K = moment.above_K,
                                 .angle_rad = {moment.turntable_rad, moment.multitooth_rad}};
    return product_.At(instant, std::array{reading_rad.x(), reading_rad.y()}) *
           Eigen::Vector2d::Unit(product_.Channel());
  }

 private:
  model::Product product_;
};

}  // namespace

TurntableEffectPointer MakeAutocollimatorSignal(const EffectSettings& effect, const Scenario& scenario) {
  return std::make_unique<AutocollimatorSignal>(effect, scenario);
}

}  // namespace twinbench::sim
