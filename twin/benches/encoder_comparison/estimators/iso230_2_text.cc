#include <fmt/core.h>

#include <cmath>

#include "twin/benches/encoder_comparison/estimators/iso230_2.h"
#include "twin/core/units.h"

namespace twinbench::measure {
namespace {

std::string Fine(double value, const ToldIn& told) {
  if (std::isnan(value)) return fmt::format(" {:>8}", "-");
  return fmt::format(" {:8.3f}", value / told.fine);
}

std::string Row(const TargetPositioning& t, const ToldIn& told) {
  const ApproachPositioning &f = t.forward, &b = t.backward;
  std::string row = fmt::format("{:10.4f}{:5d}{:5d}", t.position / told.coarse, f.runs, b.runs);
  for (const double value : {f.mean, b.mean, t.mean, f.deviation, b.deviation, t.reversal, f.Repeatability(),
                             b.Repeatability(), t.repeatability.value})
    row += Fine(value, told);
  return row + "\n";
}

}  // namespace

/// Values that the runs do not give have no row.
std::string AxisText(const AxisPositioning& positioning, const ToldIn& told) {
  bool has_u = false;
  std::string text = fmt::format("axis        value        u     bias   (ISO 230-2, {})\n", told.fine_name);
  for (std::size_t i = 0; i < kAxisValues; ++i) {
    const ScatteredValue& v = positioning.axis[i];
    if (std::isnan(v.value)) continue;
    has_u = has_u || !std::isnan(v.u);
    text += fmt::format("{:<8}", kAxisValueNames[i]) + Fine(v.value, told) + Fine(v.u, told) + Fine(v.bias, told) +
            "\n";
  }
  return text + (has_u ? "u and bias hold the scatter of the runs only\n" : "");
}

std::string PositioningText(const AxisPositioning& positioning, const ToldIn& told) {
  std::string text = fmt::format("ISO 230-2, {}; + forward, - backward\n", told.fine_name);
  text += fmt::format("{:<10} ", "target_" + told.coarse_name) +
          "  n+   n-    mean+    mean-     mean       s+       s-      B_i     R_i+     R_i-      R_i\n";
  for (const TargetPositioning& target : positioning.targets) text += Row(target, told);
  return text + "\n" + AxisText(positioning, told);
}

}  // namespace twinbench::measure
