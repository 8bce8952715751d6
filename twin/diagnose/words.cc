#include "twin/diagnose/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/unit_text.h"

namespace twinbench::diagnose {
namespace {

/// With the space before it.
std::string SpacedUnit(const std::string& unit) {
  const std::string text = UnitInPrint(unit);
  return text.empty() ? "" : " " + text;
}

}  // namespace

std::string Place(const std::string& effect, const std::string& where) {
  return where.empty() ? effect : effect + " at " + where;
}

std::string Percent(double share) {
  if (!std::isfinite(share)) return "-";
  const double percent = std::round(100.0 * share) + 0.0;  // no minus before nothing
  return share > 0.0 && share < 0.01 ? "< 1 %" : fmt::format("{:.0f} %", percent);
}

ChannelUnit FinerUnit(const ChannelUnit& unit, double largest_SI) {
  constexpr double kBelow = 0.1, kFiner = 1e-3;
  if (unit.name != "mm" || !(std::abs(largest_SI / unit.to_SI) < kBelow)) return unit;
  return {"um", kFiner * unit.to_SI};
}

std::string WithUncertainty(const ParameterEstimate& p) {
  const ChannelUnit told = FinerUnit({p.unit, p.to_SI}, p.value);
  const double value = p.value / told.to_SI, u = p.u / told.to_SI;
  const std::string unit = SpacedUnit(told.name);
  if (!std::isfinite(u) || u <= 0.0) return fmt::format("{:.3g}{}", value, unit);
  const int decimals = static_cast<int>(1.0 - std::floor(std::log10(u)));
  if (decimals > 9) return fmt::format("{:.4g} ± {:.2g}{}", value, u, unit);
  const double shown = std::abs(value) < 0.5 * std::pow(10.0, -decimals) ? 0.0 : value;  // no minus before nothing
  return fmt::format("{:.{}f} ± {:.{}f}{}", shown, std::max(decimals, 0), u, std::max(decimals, 0), unit);
}

std::string NameAndSize(const ParameterEstimate& p) {
  std::string name = p.name;
  std::ranges::replace(name, '_', ' ');
  return name + " " + WithUncertainty(p);
}

std::string GainInWords(const Gain& gain, const LinearRun& run) {
  if (gain.folds == 0) return "";
  if (!gain.positive)
    return "on passes that it was not fitted to, the extended model does not predict better; do not build on it";
  const ChannelUnit told = FinerUnit({run.unit, run.to_SI}, gain.before_m);
  const auto in_unit = [&](double SI) { return fmt::format("{:.3g}", SI / told.to_SI); };
  const std::string sizes = run.IsMixed()
                                ? fmt::format("from {:.3g} to {:.3g} times what noise leaves",
                                              gain.before_m / gain.noise_floor_m, gain.after_m / gain.noise_floor_m)
                                : fmt::format("from {} to {} {}, noise alone leaves {}", in_unit(gain.before_m),
                                              in_unit(gain.after_m), told.name, in_unit(gain.noise_floor_m));
  return fmt::format("on passes that the model was not fitted to, its error falls {}", sizes);
}

}  // namespace twinbench::diagnose
