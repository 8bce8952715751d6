#include "twin/benches/encoder_comparison/estimators/lap_scatter.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace twinbench::separate::encoder {
namespace {

constexpr double kFullLap = 0.75;  // of the readings of the fullest lap of its pass

/// Sum over the readings of one lap of rest x exp(-j k th), k = 1 .. highest.
struct LapSum {
  Eigen::VectorXcd sum;
  int readings = 0;
};

std::map<int, LapSum> LapsOf(const ComparedPass& pass, const Eigen::VectorXd& th_rad,
                             const Eigen::VectorXd& rest_rad, int highest) {
  std::map<int, LapSum> laps;
  for (Eigen::Index i = 0; i < th_rad.size(); ++i) {
    LapSum& lap = laps[pass.lap[static_cast<std::size_t>(i)]];
    if (lap.readings++ == 0) lap.sum = Eigen::VectorXcd::Zero(highest);
    const harmonics::Complex step = std::polar(1.0, -th_rad[i]);
    harmonics::Complex term = rest_rad[i];
    for (int k = 0; k < highest; ++k) lap.sum[k] += term *= step;
  }
  return laps;
}

std::vector<LapSum> FullLaps(const FittedGroup& fitted, int highest) {
  std::vector<LapSum> full;
  for (std::size_t p = 0; p < fitted.th_rad.size(); ++p) {
    const auto laps = LapsOf(fitted.group->passes[p], fitted.th_rad[p], fitted.fit.rest_rad[p], highest);
    int fullest = 0;
    for (const auto& [index, lap] : laps) fullest = std::max(fullest, lap.readings);
    for (const auto& [index, lap] : laps) {
      if (lap.readings >= kFullLap * fullest) full.push_back(lap);
    }
  }
  return full;
}

Eigen::VectorXd PooledWithNeighbours(const Eigen::VectorXd& single, int pooled_orders) {
  Eigen::VectorXd pooled(single.size());
  for (Eigen::Index k = 0; k < single.size(); ++k) {
    const Eigen::Index first = k - std::min<Eigen::Index>(k, pooled_orders);
    const Eigen::Index last = std::min<Eigen::Index>(single.size() - 1, 2 * k - first);
    pooled[k] = single.segment(first, last - first + 1).mean();
  }
  return pooled;
}

}  // namespace

OrderNoise NoiseOf(const std::vector<FittedGroup>& groups, int highest, int pooled_orders) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(highest);
  double rest2 = 0.0, dof = 0.0, changes = 0.0;
  for (const FittedGroup& fitted : groups) {
    rest2 += fitted.fit.RestSum2();
    dof += fitted.fit.dof;
    const std::vector<LapSum> laps = FullLaps(fitted, highest);
    if (laps.size() < 2) continue;
    // White noise gives E |sum|^2 = n variance; the common curve takes one lap of them away.
    for (const LapSum& lap : laps) squares += lap.sum.cwiseAbs2() / lap.readings;
    changes += static_cast<double>(laps.size()) - 1.0;
  }
  OrderNoise noise;
  noise.white_rad2 = dof > 0.0 ? rest2 / dof : kNaN;
  noise.between_laps = changes > 0.0;
  noise.dof = noise.between_laps ? 2.0 * changes : dof;
  noise.variance_rad2 = noise.between_laps ? PooledWithNeighbours(squares / changes, pooled_orders)
                                           : Eigen::VectorXd::Constant(highest, noise.white_rad2);
  return noise;
}

}  // namespace twinbench::separate::encoder
