#include "twin/benches/turntable_autocollimator/estimators/noise.h"

#include <Eigen/Core>
#include <cmath>
#include <map>
#include <tuple>

namespace twinbench::separate::turntable {

AutocollimatorNoise NoiseOfRepeats(const std::vector<TurntableStop>& stops, const StopGrid& grid) {
  using Repeats = std::vector<Eigen::Array2d>;
  std::map<std::tuple<int, int, int>, Repeats> repeats_at;
  for (const GridStop& g : grid.stops) {
    const TurntableStop& stop = stops[g.stop];
    repeats_at[{g.setup, g.position, stop.direction}].push_back({stop.x_rad, stop.y_rad});
  }
  Eigen::Array2d squares = Eigen::Array2d::Zero();
  AutocollimatorNoise noise;
  for (const auto& [where, repeats] : repeats_at) {
    Eigen::Array2d mean = Eigen::Array2d::Zero();
    for (const Eigen::Array2d& r : repeats) mean += r / static_cast<double>(repeats.size());
    for (const Eigen::Array2d& r : repeats) squares += (r - mean).square();
    noise.dof += static_cast<int>(repeats.size()) - 1;
  }
  if (noise.dof == 0) return noise;
  noise.u_x_rad = std::sqrt(squares.x() / noise.dof);
  noise.u_y_rad = std::sqrt(squares.y() / noise.dof);
  return noise;
}

}  // namespace twinbench::separate::turntable
