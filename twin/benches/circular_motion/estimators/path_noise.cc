#include "twin/benches/circular_motion/estimators/path_noise.h"

#include <algorithm>
#include <cmath>

#include "twin/core/robust_scale.h"
#include "twin/core/rounding.h"

namespace twinbench::separate::circular {
namespace {

constexpr int kDifferenced = 4;  // readings of a third difference

/// Of the values at these angles, however they are spaced, in standard deviations of white noise; NaN where angles are the same.
double ThirdDifference(const PathPoint* at) {
  constexpr double kSame_rad = 1e-9;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kDifferenced; ++i) {
    double weight = 1.0;
    for (int k = 0; k < kDifferenced; ++k) {
      const double apart_rad = std::remainder(at[i].commanded_rad - at[k].commanded_rad, units::turn);
      if (k != i && std::abs(apart_rad) < kSame_rad) return kNaN;
      if (k != i) weight /= apart_rad;
    }
    sum += weight * at[i].Radial_m();
    squares += weight * weight;
  }
  return sum / std::sqrt(squares);
}

/// Those of what jumps (a single reading that is far off, a reversal) do not count.
double ScatterOf_m(const CirclePath& path, double least_m) {
  constexpr double kFar = 4.0;
  std::vector<double> sizes_m;
  for (std::size_t i = 0; i + kDifferenced <= path.points.size(); ++i) {
    const double size_m = std::abs(ThirdDifference(&path.points[i]));
    if (std::isfinite(size_m)) sizes_m.push_back(size_m);
  }
  if (sizes_m.empty()) return 0.0;
  const double limit_m = kFar * std::max(RobustDeviation(sizes_m), least_m);
  double squares = 0.0, count = 0.0;
  for (const double size_m : sizes_m) {
    if (size_m > limit_m) continue;
    squares += size_m * size_m;
    ++count;
  }
  return std::sqrt(squares / count);
}

/// So coarse that all readings show one of a few values, which are too few to have a common step: the least that two are apart.
double CoarseStep_m(Eigen::VectorXd shown_m) {
  constexpr int kMost = 17;  // values
  constexpr double kSame_m = 1e-12;
  std::ranges::sort(shown_m);
  double step_m = 0.0;
  int values = 1;
  for (Eigen::Index i = 1; i < shown_m.size(); ++i) {
    const double apart_m = shown_m[i] - shown_m[i - 1];
    if (apart_m < kSame_m) continue;
    step_m = step_m > 0.0 ? std::min(step_m, apart_m) : apart_m;
    ++values;
  }
  return values <= kMost ? step_m : 0.0;
}

double StepOf_m(const CirclePath& path) {
  Eigen::VectorXd shown_m(std::ssize(path.points));
  for (Eigen::Index i = 0; i < shown_m.size(); ++i) shown_m[i] = path.points[static_cast<std::size_t>(i)].shown_m;
  if (!shown_m.allFinite()) return 0.0;
  const double step_m = CommonStep(shown_m);
  return step_m > 0.0 ? step_m : CoarseStep_m(std::move(shown_m));
}

void TakeNoiseAsRead(CirclePath& path) {
  constexpr std::size_t kFewest = 60;  // further apart, the third differences of what the radius does are no noise
  if (path.points.size() < kFewest) return;
  const double of_step_m = StepOf_m(path) / std::sqrt(12.0);
  const double sigma_m = std::max(ScatterOf_m(path, of_step_m), of_step_m);
  if (!(sigma_m > 0.0)) return;
  for (PathPoint& point : path.points) {
    point.u_own_m.x() = sigma_m;
    if (of_step_m == 0.0) continue;
    const double steps = std::pow(of_step_m / sigma_m, 2), others = 1.0 - point.of_steps.x();
    point.of_machine.x() *= others > 0.0 ? (1.0 - steps) / others : 0.0;
    point.of_steps.x() = steps;
  }
}

}  // namespace

std::vector<CirclePath> WithNoiseAsRead(std::vector<CirclePath> paths) {
  for (CirclePath& path : paths) TakeNoiseAsRead(path);
  return paths;
}

}  // namespace twinbench::separate::circular
