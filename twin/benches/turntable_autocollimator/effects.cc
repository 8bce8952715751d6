#include "twin/benches/turntable_autocollimator/format.h"
#include "twin/core/effect_entries.h"

namespace twinbench::benches::turntable {
namespace {

const std::vector<std::string>& AutocollimatorAxes() {
  static const std::vector<std::string> axes = {"x", "y"};
  return axes;
}

// Defaults are sizes that are plausible before checking; the ranges stand beside the entries.
std::vector<EffectEntry> InstrumentEffects() {
  return {
      // 0.6 deg and a tilt of 100 arcsec make 1.05 arcsec
      {"autocollimator_roll",
       "crosshair rolled against the turntable's axis, beyond what is stated",
       {},
       {Signed("angle", "mrad", 5.0, 500.0, "x' = x + y' sin(angle)").Adds("autocollimator.roll_mrad")}},
      // 0.05-0.5 %
      {"autocollimator_scale", "wrong scale of both axes", {}, {Signed("gain_error", "1", 0.003, 0.5, "relative")}},
      // vignetting, distortion
      {"autocollimator_nonlinearity",
       "error with the cube of the angle: distortion, vignetting at the edge",
       {},
       {Signed("at_edge", "arcsec", 0.5, 100.0, "error at the edge of the stated range")
            .Adds("autocollimator.error_at_edge_arcsec")}},
      // 0.02-0.5 arcsec
      {"autocollimator_periodic",
       "error that repeats with the pixels",
       AutocollimatorAxes(),
       {Signed("amplitude", "arcsec", 0.2, 100.0, "of amplitude * cos(2 pi reading / period + phase)"),
        Parameter("period", "arcsec", 1.7, 0.1, 1000.0, "of the same"),
        Signed("phase", "deg", 0.0, 360.0, "of the same")}},
      // beam walk: 79 nm over 60 mm and 1 mm make 0.036 arcsec
      {"mirror_flatness",
       "mirror that is not flat, met off its middle where the multi-tooth table is eccentric",
       {},
       {Signed("sag", "nm", 80.0, 100000.0, "over its width, beyond what is stated; positive: hollow")
            .Adds("mirror.flatness_nm")}},
  };
}

std::vector<EffectEntry> TurntableTimeEffects() {
  return {
      {"autocollimator_drift",
       "zero that drifts with time",
       AutocollimatorAxes(),
       {Signed("rate", "arcsec_per_h", 0.5, 3600.0, "mean rate over the first hour"),
        Signed("curvature", "1", 0.0, 5.0, "share of a quadratic part, zero at 0 and 1 h")}},
      // 0.05-0.2 arcsec/K
      {"autocollimator_temperature",
       "zero that follows the temperature, beyond what is stated",
       AutocollimatorAxes(),
       {Signed("coefficient", "arcsec_per_K", 0.2, 1000.0, "of the zero, per kelvin")
            .Adds("autocollimator.@_per_kelvin_arcsec")}},
      {"mount_creep",
       "mounting that creeps once it is made",
       AutocollimatorAxes(),
       {Signed("amplitude", "arcsec", 0.5, 1000.0, "of amplitude * ln(1 + time since mounting / time_constant)"),
        Parameter("time_constant", "s", 60.0, 1.0, 1e5, "of the same")}},
      // a knock, a clamp that gave way
      {"slip",
       "sudden step",
       AutocollimatorAxes(),
       {Signed("step", "arcsec", 2.0, 400.0, "size"),
        Parameter("at_reading", "1", 100.0, 0.0, 1e9, "first reading behind the step")}},
      {"tone",
       "slow periodic disturbance: air conditioning, aliased mains",
       AutocollimatorAxes(),
       {Signed("amplitude", "arcsec", 0.3, 100.0, "of amplitude * cos(2 pi frequency time + phase)"),
        Parameter("frequency", "Hz", 0.001, 1e-6, 1e6, "of the same"),
        Signed("phase", "deg", 0.0, 360.0, "of the same")}},
  };
}

std::vector<EffectEntry> TurntableBodyEffects() {
  return {
      // 0.1-20 arcsec
      {"backlash",
       "turntable that stands elsewhere when it comes from the other side",
       {},
       {Signed("width", "arcsec", 1.0, 3600.0, "of the gap")}},
      {"settling",
       "turntable that has not come to rest when it is read",
       {},
       {Signed("amplitude", "arcsec", 1.0, 3600.0, "behind, at the end of the move"),
        Parameter("time_constant", "s", 1.0, 0.01, 1000.0, "of the decay")}},
      // 0.05-0.3 arcsec a lift
      {"multitooth_seating",
       "teeth that seat differently at every lift, beyond what is stated",
       {},
       {Parameter("scatter", "arcsec", 0.3, 0.0, 100.0, "standard deviation of x")}},
      {"outliers",
       "readings that are disturbed for no lasting reason",
       {},
       {Parameter("fraction", "1", 0.01, 0.0, 0.5, "share of the readings"),
        Parameter("size", "arcsec", 3.0, 0.0, 400.0, "typical size on one axis")}},
  };
}

}  // namespace

std::vector<EffectEntry> Effects() {
  return Joined({InstrumentEffects(), TurntableTimeEffects(), TurntableBodyEffects()});
}

}  // namespace twinbench::benches::turntable
