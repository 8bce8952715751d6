#include "twin/benches/rotary_4dof/estimators/verification.h"

#include <cmath>
#include <numeric>

#include "twin/core/errors.h"

namespace twinbench::measure {
namespace {

struct Spread {
  double rms = kNaN;
  double max = kNaN;
};

Spread SpreadAboutMean(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  Spread spread{0.0, 0.0};
  for (const double value : values) {
    spread.rms += (value - mean) * (value - mean);
    spread.max = std::max(spread.max, std::abs(value - mean));
  }
  spread.rms = std::sqrt(spread.rms / (n - 1.0));
  return spread;
}

}  // namespace

Verification SummariseVerification(const std::vector<Motion>& motions, const std::vector<Reading>& readings,
                                   double autocollimator_gain) {
  Require(motions.size() == readings.size(), "verification needs one motion a reading");
  std::vector<double> yaw_rad, tilt_rad;
  Vector4 variance = Vector4::Zero();
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const Motion& motion = motions[k];
    if (motion.phase != Phase::kVerification || motion.status != ReadingStatus::kOk) continue;
    if (std::isnan(readings[k].autocollimator_yaw_rad) || std::isnan(readings[k].autocollimator_tilt_rad)) continue;
    yaw_rad.push_back(motion.ez_rad - readings[k].autocollimator_yaw_rad / autocollimator_gain);
    tilt_rad.push_back(motion.ex_rad - readings[k].autocollimator_tilt_rad / autocollimator_gain);
    variance += motion.cov.diagonal() + motion.cov_systematic.diagonal();
  }
  Verification result;
  result.readings = static_cast<int>(yaw_rad.size());
  if (yaw_rad.size() < 2) return result;
  const Spread yaw = SpreadAboutMean(yaw_rad), tilt = SpreadAboutMean(tilt_rad);
  const double n = static_cast<double>(yaw_rad.size());
  return {result.readings,           yaw.rms, yaw.max, tilt.rms, tilt.max, std::sqrt(variance[0] / n),
          std::sqrt(variance[1] / n)};
}

}  // namespace twinbench::measure
