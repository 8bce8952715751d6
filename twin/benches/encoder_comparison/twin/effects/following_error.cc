#include "twin/benches/encoder_comparison/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// Feedforward of the acceleration that is missing, or is too large.
class Inert : public AngleEffect {
 public:
  explicit Inert(const EffectSettings& e) : coefficient_s2_(Parameter(e, "coefficient")) {}
  double ShaftError_rad(const AngleMoment& moment) const override { return -coefficient_s2_ * moment.acceleration_rad_s2; }

 private:
  double coefficient_s2_;
};

/// What a controller needs to be behind by to push against friction; at rest it takes it away.
class Rubbing : public AngleEffect {
 public:
  explicit Rubbing(const EffectSettings& e) : lag_rad_(Parameter(e, "lag")) {}
  double ShaftError_rad(const AngleMoment& moment) const override { return -lag_rad_ * moment.goes; }

 private:
  double lag_rad_;
};

}  // namespace

AngleEffectPointer MakeAccelerationError(const EffectSettings& settings) { return std::make_unique<Inert>(settings); }

AngleEffectPointer MakeFriction(const EffectSettings& settings) { return std::make_unique<Rubbing>(settings); }

}  // namespace twinbench::sim
