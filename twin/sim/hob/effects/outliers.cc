#include "twin/core/stream.h"
#include "twin/sim/hob/effects/effects.h"

namespace twinbench::sim {
namespace {

/// Now and then a sample is off by 0.5 to 1.5 times the typical size, either way. Which ones, follows from their
/// numbers.
class CounterOutliers : public HobEffect {
 public:
  CounterOutliers(const EffectSettings& e, const Scenario& scenario)
      : fraction_(Parameter(e, "fraction")), size_rad_(Parameter(e, "size")), seed_(scenario.seed) {}
  ShownError Shown(const HobMoment& moment) override {
    Stream stream(seed_, "effect.outliers");
    stream.Seek(2 * static_cast<std::uint64_t>(moment.reading));  // a block has two numbers, we take three
    if (stream.Uniform() >= fraction_) return {};
    const double sign = stream.Uniform() < 0.5 ? -1.0 : 1.0;
    return {.table_rad = sign * size_rad_ * (0.5 + stream.Uniform())};
  }

 private:
  double fraction_, size_rad_;
  std::uint64_t seed_;
};

}  // namespace

HobEffectPointer MakeCounterOutliers(const EffectSettings& effect, const Scenario& scenario) {
  return std::make_unique<CounterOutliers>(effect, scenario);
}

}  // namespace twinbench::sim
