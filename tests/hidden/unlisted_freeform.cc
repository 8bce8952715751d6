#include <cmath>

#include "tests/hidden/unlisted_cause.h"
#include "twin/benches/freeform_five_axis/columns.h"

// Causes of five axes on paraboloids that the catalogue lacks.
namespace twinbench::hidden {
namespace {

using namespace benches::freeform;

constexpr Eigen::Index kProbe = 3;  // channels
constexpr Eigen::Index kCamera = 2;

/// An amplifier whose gain goes with the temperature.
UnlistedSignal WarmGain(const Draw& draw) {
  const bool x = draw.Whole(0, 1) == 0;
  const auto gain = [&](std::size_t i) {
    const Reading& r = draw.readings[i];
    return (x ? kQpdX_V(r) : kQpdY_V(r)) * (r.temperature_degC - 20.0);
  };
  return OnColumn(x ? 0 : 1, kProbe, {"temperature", "reading", "qpd"}, draw.Series(gain));
}

/// Interference in the window of the camera: a wave of what it shows.
UnlistedSignal Etalon(const Draw& draw) {
  const double period_px = UniformIn(draw.stream, 60.0, 160.0), phase = draw.Phase();
  const auto wave = [&](std::size_t i) {
    return std::cos(units::turn * kCcd_px(draw.readings[i]) / period_px + phase);
  };
  return OnColumn(kCamera, kProbe, {"reading", "ccd"}, draw.Series(wave));
}

/// A holder that gives way with both swivels at once.
UnlistedSignal BothSwivels(const Draw& draw) {
  const auto both = [&](std::size_t i) {
    return kCommanded[3](draw.readings[i]) * kCommanded[4](draw.readings[i]);
  };
  return OnColumn(kCamera, kProbe, {"angle", "a ", "b "}, draw.Series(both));
}

}  // namespace

const std::vector<UnlistedCause>& FreeformUnlistedCauses() {
  static const std::vector<UnlistedCause> causes = {
      {"gain with the temperature", WarmGain}, {"etalon", Etalon}, {"product of both swivels", BothSwivels}};
  return causes;  // constant
}

}  // namespace twinbench::hidden
