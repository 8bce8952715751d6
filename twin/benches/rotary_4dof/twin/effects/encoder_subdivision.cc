#include <fmt/format.h>

#include <cmath>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"
#include "twin/core/errors.h"

namespace twinbench::sim {
namespace {

/// The servo brings one table to where its encoder shows the command, wrong by a sine within each period.
class EncoderSubdivision : public Effect {
 public:
  explicit EncoderSubdivision(const EffectSettings& e)
      : table_(e.where == "reference" ? 1 : 0), amplitude_rad_(Parameter(e, "amplitude")), location_(e.location) {}
  void AlterBench(Scenario& actual) const override {
    MechanicsSettings& mechanics = RotaryOf(actual).mechanics;
    double& error_rad = mechanics.encoder_subdivision_rad[table_];
    error_rad += amplitude_rad_;
    if (std::abs(error_rad) * mechanics.encoder_periods < 0.9) return;
    throw InputError(location_,
                     fmt::format("a subdivision error of {:.3g} arcsec turns a graduation of {} periods back",
                                 error_rad / units::arcsec, mechanics.encoder_periods),
                     fmt::format("less than {:.3g} arcsec", 0.9 / mechanics.encoder_periods / units::arcsec));
  }

 private:
  std::size_t table_;
  double amplitude_rad_;
  std::string location_;
};

}  // namespace

EffectPointer MakeEncoderSubdivision(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<EncoderSubdivision>(settings);
}

}  // namespace twinbench::sim
