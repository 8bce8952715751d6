#include "hw_bridge/control/command_numbers.h"

#include <fmt/format.h>

#include <cmath>

#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr double kAllDigits = 1e-9;  // mm or deg (4 microarcsec): what decimal text may lose on its way

}  // namespace

std::string CommandNumbers::Text(double value_SI, double to_SI) const {
  return decimals < 0 ? PrintInUnit(value_SI, to_SI) : fmt::format("{:.{}f}", value_SI / to_SI, decimals);
}

double CommandNumbers::Understood(double to_SI) const {
  const double half_decimal = decimals < 0 ? 0.0 : 0.5 * std::pow(10.0, -decimals);
  return (half_decimal + kAllDigits) * to_SI;
}

}  // namespace twinbench::hw
