#include <cmath>

#include "twin/benches/encoder_comparison/twin/effects/effects.h"
#include "twin/model/product.h"

namespace twinbench::sim {
namespace {

/// A product of the device's angle and a course.
class AngleSignal : public AngleEffect {
 public:
  AngleSignal(const EffectSettings& effect, const Scenario& scenario)
      : product_(effect, FormatOf(scenario.bench)) {}

  double DeviceError_rad(const AngleMoment& moment, double device_rad) const override {
    const double way_rad = moment.approach_rad != 0.0 ? moment.approach_rad : moment.velocity_rad_s;
    const model::Instant instant{.time_s = ToSeconds(moment.now),
                                 .reading = moment.reading,
                                 .direction = way_rad == 0.0 ? 0.0 : std::copysign(1.0, way_rad),
                                 .velocity_rad_s = moment.velocity_rad_s,
                                 .above_K = moment.above_K,
                                 .angle_rad = {device_rad, moment.shaft_rad}};
    return product_.At(instant, std::array{device_rad});
  }

 private:
  model::Product product_;
};

}  // namespace

AngleEffectPointer MakeAngleSignal(const EffectSettings& effect, const Scenario& scenario) {
  return std::make_unique<AngleSignal>(effect, scenario);
}

}  // namespace twinbench::sim
