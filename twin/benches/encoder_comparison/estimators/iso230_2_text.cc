#include <fmt/core.h>

#include <cmath>

#include "twin/benches/encoder_comparison/estimators/iso230_2.h"
#include "twin/core/units.h"

namespace twinbench::measure {
namespace {

std::string Arcsec(double value_rad) {
  if (std::isnan(value_rad)) return fmt::format("{:>9}", "-");
  return fmt::format("{:9.3f}", value_rad / units::arcsec);
}

std::string Row(const TargetPositioning& t) {
  const ApproachPositioning &f = t.forward, &b = t.backward;
  std::string row = fmt::format("{:10.4f}{:5d}{:5d}", t.position / units::deg, f.runs, b.runs);
  for (const double value : {f.mean, b.mean, t.mean, f.deviation, b.deviation, t.reversal, f.Repeatability(),
                             b.Repeatability(), t.repeatability.value})
    row += Arcsec(value);
  return row + "\n";
}

}  // namespace

std::string AxisText(const AxisPositioning& positioning) {
  std::string text = "axis        value        u     bias   (ISO 230-2, arcsec)\n";
  for (std::size_t i = 0; i < kAxisValues; ++i) {
    const ScatteredValue& v = positioning.axis[i];
    text += fmt::format("{:<8}", kAxisValueNames[i]) + Arcsec(v.value) + Arcsec(v.u) + Arcsec(v.bias) + "\n";
  }
  return text + "u and bias hold the scatter of the runs only\n";
}

std::string PositioningText(const AxisPositioning& positioning) {
  std::string text = "ISO 230-2, arcsec; + forward, - backward\n";
  text += "target_deg   n+   n-    mean+    mean-     mean       s+       s-      B_i     R_i+     R_i-      R_i\n";
  for (const TargetPositioning& target : positioning.targets) text += Row(target);
  return text + "\n" + AxisText(positioning);
}

}  // namespace twinbench::measure
