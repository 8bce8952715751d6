#include "twin/benches/encoder_comparison/estimators/vdi3441.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/estimators/positioning_scatter.h"

namespace twinbench::measure {
namespace {

/// In the order of VdiValue.
Eigen::ArrayXd VdiFigures(const Side& f, const Side& b) {
  constexpr auto wins = Eigen::PropagateNaN;  // one value that is not available makes the largest not available
  const Eigen::ArrayXd mean = 0.5 * (f.mean + b.mean), reversal = (f.mean - b.mean).abs(), scatter = 3.0 * (f.deviation + b.deviation);
  const Eigen::ArrayXd half = 0.5 * (reversal + scatter);
  Eigen::ArrayXd values(kVdiValues);
  values << (mean + half).maxCoeff<wins>() - (mean - half).minCoeff<wins>(),                                    // P
      scatter.maxCoeff<wins>(), scatter.mean(), mean.maxCoeff<wins>() - mean.minCoeff<wins>(),                 // Ps, mean Ps, Pa
      reversal.maxCoeff<wins>(), reversal.mean();                                                              // U, mean U
  return values;
}

}  // namespace

VdiPositioning EvaluateVdi3441(const std::vector<TargetPositioning>& targets, const PositioningBootstrap& bootstrap) {
  VdiPositioning result;
  if (targets.empty()) return result;
  const std::vector<ScatteredValue> values = WithScatter(targets, VdiFigures, bootstrap, "vdi3441.bootstrap");
  std::copy_n(values.begin(), kVdiValues, result.axis.begin());
  return result;
}

std::string VdiText(const VdiPositioning& positioning, const ToldIn& told) {
  std::string text;
  for (std::size_t i = 0; i < kVdiValues; ++i) {
    const ScatteredValue& v = positioning.axis[i];
    if (std::isnan(v.value)) continue;
    text += text.empty() ? fmt::format("VDI/DGQ 3441, {}:", told.fine_name) : ",";
    text += fmt::format(" {} {:.3f}", kVdiValueNames[i], v.value / told.fine);
    if (!std::isnan(v.u)) text += fmt::format(" ± {:.3f}", v.u / told.fine);
  }
  return text.empty() ? text : text + "\n";
}

}  // namespace twinbench::measure
