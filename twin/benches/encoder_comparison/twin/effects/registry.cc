#include <fmt/core.h>

#include <functional>
#include <map>

#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/encoder_comparison/twin/effects/effects.h"
#include "twin/core/errors.h"

namespace twinbench::sim {
namespace {

/// Periods a turn of an error that repeats with the lines of the scale.
double LineOrder(const EffectSettings& effect, const Scenario& scenario) {
  if (EncoderOf(scenario).device.lines > 0) return Parameter(effect, "order") * EncoderOf(scenario).device.lines;
  throw InputError(effect.location, "the effect interpolation needs the lines of the scale",
                   "device.lines_per_turn above 0");
}

}  // namespace

AngleEffectPointer MakeAngleEffect(const EffectSettings& effect, const Scenario& scenario) {
  const std::map<std::string, std::function<AngleEffectPointer()>> makers = {
      {"eccentricity", [&] { return MakeHarmonic(effect, 1.0); }},
      {"ellipticity", [&] { return MakeHarmonic(effect, 2.0); }},
      {"periodic", [&] { return MakeHarmonic(effect, Parameter(effect, "order")); }},
      {"gear_mesh", [&] { return MakeHarmonic(effect, Parameter(effect, "teeth")); }},
      {"interpolation", [&] { return MakeHarmonic(effect, LineOrder(effect, scenario)); }},
      {"signal_offset", [&] { return MakeSignalFault(effect); }},
      {"amplitude_mismatch", [&] { return MakeSignalFault(effect); }},
      {"quadrature_error", [&] { return MakeSignalFault(effect); }},
      {"signal_clipping", [&] { return MakeSignalFault(effect); }},
      {"latency", [&] { return MakeLatency(effect); }},
      {"clock_rate", [&] { return MakeClockRate(effect); }},
      {"acceleration_error", [&] { return MakeAccelerationError(effect); }},
      {"friction", [&] { return MakeFriction(effect); }},
      {"backlash", [&] { return MakeGap(effect); }},
      {"hysteresis", [&] { return MakeHysteresis(effect); }},
      {"signal", [&] { return MakeAngleSignal(effect, scenario); }},
      {"settling", [&] { return MakeSettling(effect); }},
      {"scale", [&] { return MakeScale(effect); }},
      {"drift", [&] { return MakeZeroDrift(effect); }},
      {"zero_temperature", [&] { return MakeZeroTemperature(effect); }},
      {"slip", [&] { return MakeZeroSlip(effect); }},
      {"reference_fault", [&] { return MakeReferenceFault(effect); }},
      {"outliers", [&] { return MakeAngleOutliers(effect, scenario); }},
  };
  const auto found = makers.find(effect.name);
  Require(found != makers.end(), "the catalogue has an effect that the twin has not");
  return found->second();
}

}  // namespace twinbench::sim
