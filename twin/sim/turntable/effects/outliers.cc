#include "twin/core/stream.h"
#include "twin/sim/turntable/effects/effects.h"

namespace twinbench::sim {
namespace {

/// Now and then a reading of one axis is off by 0.5 to 1.5 times the typical size, either way: a draught in the
/// beam. Which ones, follows from their numbers.
class AutocollimatorOutliers : public TurntableEffect {
 public:
  AutocollimatorOutliers(const EffectSettings& e, const Scenario& scenario)
      : fraction_(Parameter(e, "fraction")), size_rad_(Parameter(e, "size")), seed_(scenario.seed) {}
  Eigen::Vector2d ReadingError_rad(const TurntableMoment& moment, const Eigen::Vector2d&) const override {
    Stream stream(seed_, "effect.outliers");
    stream.Seek(2 * static_cast<std::uint64_t>(moment.reading));  // a block has two numbers, we take four
    if (stream.Uniform() >= fraction_) return Eigen::Vector2d::Zero();
    const std::string where = stream.Uniform() < 0.5 ? "x" : "y";
    const double sign = stream.Uniform() < 0.5 ? -1.0 : 1.0;
    return OnAxis(where, sign * size_rad_ * (0.5 + stream.Uniform()));
  }

 private:
  double fraction_, size_rad_;
  std::uint64_t seed_;
};

}  // namespace

TurntableEffectPointer MakeAutocollimatorOutliers(const EffectSettings& effect, const Scenario& scenario) {
  return std::make_unique<AutocollimatorOutliers>(effect, scenario);
}

}  // namespace twinbench::sim
