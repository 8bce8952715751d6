#include "twin/benches/encoder_comparison/comparison.h"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/report/json_units.h"

namespace twinbench::benches::encoder {
namespace {

std::string DirectionLine(const char* name, double mean_rad, const AxisUnit& unit) {
  if (!std::isfinite(mean_rad)) return "";
  return fmt::format("mean, direction {}   {:+.6f} {}\n", name, mean_rad / unit.to_SI, unit.name);
}

}  // namespace

std::string Summary(const measure::AngleComparison& c, const AxisUnit& unit) {
  std::string text = fmt::format("{} readings", c.used.size() + c.left_out);
  text += c.left_out > 0 ? fmt::format(", {} without a value\n", c.left_out) : "\n";
  if (c.used.empty()) return text;
  text += fmt::format("measured - reference, mean of each mounting taken out\nrms                   {:.6f} {}\n",
                      c.rms_rad / unit.to_SI, unit.name);
  text += fmt::format("range                 {:.6f} {}\n", c.range_rad / unit.to_SI, unit.name);
  return text + DirectionLine("+1", c.mean_forward_rad, unit) + DirectionLine("-1", c.mean_backward_rad, unit);
}

nlohmann::json ToJson(const measure::AngleComparison& c) {
  return {{"readings", c.used.size()},
          {"left_out", c.left_out},
          {"rms_deg", report::In(units::deg, c.rms_rad)},
          {"range_deg", report::In(units::deg, c.range_rad)},
          {"mean_forward_deg", report::In(units::deg, c.mean_forward_rad)},
          {"mean_backward_deg", report::In(units::deg, c.mean_backward_rad)}};
}

}  // namespace twinbench::benches::encoder
