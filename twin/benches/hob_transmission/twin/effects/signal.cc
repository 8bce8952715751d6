#include <cmath>

#include "twin/benches/hob_transmission/twin/effects/effects.h"
#include "twin/model/product.h"

namespace twinbench::sim {
namespace {

/// A product of what the table's encoder or the interferometer shows and a course.
class HobSignal : public HobEffect {
 public:
  HobSignal(const EffectSettings& effect, const Scenario& scenario) : product_(effect, FormatOf(scenario.bench)) {}

  ShownError Shown(const HobMoment& moment) override {
    if (moment.velocity_rad_s != 0.0) direction_ = std::copysign(1.0, moment.velocity_rad_s);
    const model::Instant instant{.time_s = ToSeconds(moment.now),
                                 .reading = moment.reading,
                                 .direction = direction_,
                                 .velocity_rad_s = moment.velocity_rad_s,
                                 .angle_rad = {moment.table_rad, 0.0}};
    const double added_rad = product_.At(instant, std::array{0.0, 0.0});
    const bool of_encoder = product_.Channel() == 0;
    return {.table_rad = of_encoder ? added_rad : 0.0, .interferometer_rad = of_encoder ? 0.0 : added_rad};
  }

 private:
  model::Product product_;
  double direction_ = 1.0;
};

}  // namespace

HobEffectPointer MakeHobSignal(const EffectSettings& effect, const Scenario& scenario) {
  return std::make_unique<HobSignal>(effect, scenario);
}

}  // namespace twinbench::sim
