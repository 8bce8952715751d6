#include "twin/core/stream.h"
#include "twin/sim/encoder/effects/effects.h"

namespace twinbench::sim {
namespace {

/// Now and then a reading is off by 0.5 to 1.5 times the typical size, either way. Which ones, follows from their
/// numbers.
class AngleOutliers : public AngleEffect {
 public:
  AngleOutliers(const EffectSettings& e, const Scenario& scenario)
      : fraction_(Parameter(e, "fraction")), size_rad_(Parameter(e, "size")), seed_(scenario.seed) {}
  double DeviceError_rad(const AngleMoment& moment, double) const override {
    Stream stream(seed_, "effect.outliers");
    stream.Seek(2 * static_cast<std::uint64_t>(moment.reading));  // a block has two numbers, we take three
    if (stream.Uniform() >= fraction_) return 0.0;
    const double sign = stream.Uniform() < 0.5 ? -1.0 : 1.0;
    return sign * size_rad_ * (0.5 + stream.Uniform());
  }

 private:
  double fraction_, size_rad_;
  std::uint64_t seed_;
};

}  // namespace

AngleEffectPointer MakeAngleOutliers(const EffectSettings& settings, const Scenario& scenario) {
  return std::make_unique<AngleOutliers>(settings, scenario);
}

}  // namespace twinbench::sim
