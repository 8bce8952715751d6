#include "twin/benches/rotary_4dof/estimators/stability.h"

#include <algorithm>
#include <cmath>

namespace twinbench::measure {
namespace {

std::vector<const Motion*> Valid(const std::vector<Motion>& motions) {
  std::vector<const Motion*> valid;
  for (const Motion& motion : motions) {
    if (motion.phase == Phase::kStability && motion.status == ReadingStatus::kOk) valid.push_back(&motion);
  }
  return valid;
}

}  // namespace

double DisplacementPerWavelength(const BenchGeometry& geometry) {
  const double sin_theta = geometry.SinTheta(), cos_theta = std::sqrt(1.0 - sin_theta * sin_theta);
  const double l1_m = 0.5 * (geometry.psd_distance_m[0] + geometry.psd_distance_m[1]);
  return -l1_m * geometry.lines_per_m / (cos_theta * sin_theta);
}

Stability SummariseStability(const std::vector<Motion>& motions, const BenchGeometry& geometry) {
  const auto valid = Valid(motions);
  Stability result;
  result.readings = static_cast<int>(valid.size());
  result.left_out = static_cast<int>(std::count_if(motions.begin(), motions.end(), [](const Motion& m) {
    return m.phase == Phase::kStability && m.status != ReadingStatus::kOk;
  }));
  if (valid.size() < 2) return result;

  Vector4 low = valid[0]->Values(), high = low, sum = Vector4::Zero(), variance = Vector4::Zero();
  for (const Motion* motion : valid) {
    low = low.cwiseMin(motion->Values());
    high = high.cwiseMax(motion->Values());
    sum += motion->Values();
    variance += motion->cov.diagonal();
  }
  const double n = static_cast<double>(valid.size());
  Vector4 squares = Vector4::Zero();
  for (const Motion* motion : valid) squares += (motion->Values() - sum / n).cwiseAbs2();
  result.duration_s = ToSeconds(valid.back()->time - valid.front()->time);
  result.range = high - low;
  result.deviation = (squares / (n - 1.0)).cwiseSqrt();
  result.u_deviation = result.deviation / std::sqrt(2.0 * (n - 1.0));
  result.noise = (variance / n).cwiseSqrt();
  result.wavelength_range_m = result.range[3] / std::abs(DisplacementPerWavelength(geometry));
  return result;
}

}  // namespace twinbench::measure
