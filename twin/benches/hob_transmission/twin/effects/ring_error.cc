#include <cmath>
#include <complex>

#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/hob_transmission/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// A ring that does not sit in the middle, is out of round or badly divided. The amplitude is that of what the head
/// sees, amplitude * cos(order * ring's angle + phase).
class RingError : public HobEffect {
 public:
  explicit RingError(const EffectSettings& e) : effect_(e) {}
  void AlterBench(Scenario& actual) const override {
    RingEncoderSettings& ring = effect_.where == "table" ? HobOf(actual).table_encoder : HobOf(actual).hob_encoder;
    if (effect_.name == "eccentricity") return MoveAside(ring);
    const double order = effect_.name == "ellipticity" ? 2.0 : Parameter(effect_, "order");
    ring.graduation.push_back(
        {Component::kEz, order, Parameter(effect_, "amplitude"), Parameter(effect_, "phase")});
  }

 private:
  /// A ring whose middle lies at azimuth A shows (a / R) sin(angle + A), to first order.
  void MoveAside(RingEncoderSettings& ring) const {
    const std::complex<double> there = std::polar(ring.eccentricity_m, ring.eccentricity_azimuth_rad);
    const double azimuth_rad = Parameter(effect_, "phase") + 0.5 * units::kPi;
    const std::complex<double> moved =
        there + Parameter(effect_, "amplitude") * ring.radius_m * std::polar(1.0, azimuth_rad);
    ring.eccentricity_m = std::abs(moved);
    ring.eccentricity_azimuth_rad = std::arg(moved);
  }

  EffectSettings effect_;
};

}  // namespace

HobEffectPointer MakeRingError(const EffectSettings& effect) {
  return std::make_unique<RingError>(effect);
}

}  // namespace twinbench::sim
