#include "twin/benches/encoder_comparison/comparison.h"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "twin/report/json_units.h"

namespace twinbench::benches::encoder {
namespace {

/// The constants that are no error of an angle device, but of a zero that is set by hand.
std::string MeansLine(const Eigen::VectorXd& mean_rad, const AxisUnit& unit) {
  const double least = mean_rad.minCoeff() / unit.to_SI, most = mean_rad.maxCoeff() / unit.to_SI;
  if (mean_rad.size() == 1) return fmt::format("mean taken out        {:+.6f} {}\n", least, unit.name);
  return fmt::format("means taken out       {:+.6f} to {:+.6f} {}\n", least, most, unit.name);
}

std::string DirectionLine(const char* name, double mean_rad, const AxisUnit& unit) {
  if (!std::isfinite(mean_rad)) return "";
  return fmt::format("mean, direction {}   {:+.6f} {}\n", name, mean_rad / unit.to_SI, unit.name);
}

}  // namespace

std::string Summary(const measure::AngleComparison& c, const AxisUnit& unit) {
  std::string text = fmt::format("{} readings", c.used.size() + c.left_out);
  text += c.left_out > 0 ? fmt::format(", {} without a value\n", c.left_out) : "\n";
  if (c.used.empty()) return text;
  text += "measured - reference, mean of each mounting taken out\n" + MeansLine(c.mean_rad, unit);
  text += fmt::format("rms                   {:.6f} {}\n", c.rms_rad / unit.to_SI, unit.name);
  text += fmt::format("range                 {:.6f} {}\n", c.range_rad / unit.to_SI, unit.name);
  return text + DirectionLine("+1", c.mean_forward_rad, unit) + DirectionLine("-1", c.mean_backward_rad, unit);
}

nlohmann::json ToJson(const measure::AngleComparison& c) {
  nlohmann::json mean_deg = nlohmann::json::array();
  for (const double mean_rad : c.mean_rad) mean_deg.push_back(report::In(units::deg, mean_rad));
  return {{"readings", c.used.size()},
          {"left_out", c.left_out},
          {"mean_deg", std::move(mean_deg)},
          {"rms_deg", report::In(units::deg, c.rms_rad)},
          {"range_deg", report::In(units::deg, c.range_rad)},
          {"mean_forward_deg", report::In(units::deg, c.mean_forward_rad)},
          {"mean_backward_deg", report::In(units::deg, c.mean_backward_rad)}};
}

}  // namespace twinbench::benches::encoder
