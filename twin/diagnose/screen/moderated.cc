#include "twin/diagnose/screen/moderated.h"

#include <fmt/format.h>

#include <cmath>

#include "twin/core/units.h"

namespace twinbench::diagnose::screen {

std::string SizeInWords(const ScreenTest& test) {
  const bool is_length = std::isfinite(test.effect_m), is_angle = std::isfinite(test.effect_rad);
  if (!is_length && !is_angle) return "";
  const std::string angle = is_angle ? fmt::format("{:.3g} arcsec", test.effect_rad / units::arcsec) : "";
  if (!is_length) return angle;
  const std::string length = fmt::format("{:.3g} um", test.effect_m / units::um);
  return is_angle ? fmt::format("{} ({})", length, angle) : length;
}

ScreenTest Moderated(ScreenTest test) {
  constexpr double kSeldom = 0.05;
  const std::string size = SizeInWords(test);
  if (!size.empty()) test.reading += "; size " + size;
  if (test.p > kSeldom) test.reading = "not beyond noise; loudest: " + test.reading;
  return test;
}

}  // namespace twinbench::diagnose::screen
