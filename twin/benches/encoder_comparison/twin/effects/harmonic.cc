#include <cmath>

#include "twin/benches/encoder_comparison/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// amplitude * cos(order * angle of the device's scale + phase): eccentricity, ellipticity, screws, lines, teeth.
class Harmonic : public AngleEffect {
 public:
  Harmonic(const EffectSettings& e, double order)
      : order_(order), amplitude_rad_(Parameter(e, "amplitude")), phase_rad_(Parameter(e, "phase")) {}
  double DeviceError_rad(const AngleMoment&, double device_rad) const override {
    return amplitude_rad_ * std::cos(order_ * device_rad + phase_rad_);
  }

 private:
  double order_, amplitude_rad_, phase_rad_;
};

}  // namespace

AngleEffectPointer MakeHarmonic(const EffectSettings& settings, double order) {
  return std::make_unique<Harmonic>(settings, order);
}

}  // namespace twinbench::sim
