#include <cmath>

#include "twin/benches/turntable_autocollimator/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The camera's interpolation between its pixels errs with their period.
class PixelPeriod : public TurntableEffect {
 public:
  explicit PixelPeriod(const EffectSettings& e)
      : where_(e.where),
        amplitude_rad_(Parameter(e, "amplitude")),
        period_rad_(Parameter(e, "period")),
        phase_rad_(Parameter(e, "phase")) {}
  Eigen::Vector2d ReadingError_rad(const TurntableMoment&, const Eigen::Vector2d& reading_rad) const override {
    const double shown_rad = where_ == "x" ? reading_rad.x() : reading_rad.y();
    const double phase_rad = 2.0 * units::kPi * shown_rad / period_rad_ + phase_rad_;
    return OnAxis(where_, amplitude_rad_ * std::cos(phase_rad));
  }

 private:
  std::string where_;
  double amplitude_rad_, period_rad_, phase_rad_;
};

}  // namespace

TurntableEffectPointer MakePixelPeriod(const EffectSettings& effect) {
  return std::make_unique<PixelPeriod>(effect);
}

}  // namespace twinbench::sim
