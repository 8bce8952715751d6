#include "optics/collimator_pupil.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace twinbench::optics {
namespace {

/// Rings are turned against each other by the golden angle: a straight edge then meets their points one by one.
constexpr double kTurn_rad = 2.0 * std::numbers::pi * (2.0 - std::numbers::phi);

/// Of ring i out of `rings` in a disc of radius one: half of the ring's area is inside.
double RingRadius(int i, int rings) {
  return std::sqrt(0.5 * (i * i + (i - 1) * (i - 1))) / rings;
}

}  // namespace

std::vector<Eigen::Vector2d> EqualAreaDisc(double radius_m, int rings) {
  if (!(radius_m > 0.0) || std::isinf(radius_m)) throw std::invalid_argument("disc: radius_m must be positive");
  if (rings < 1 || rings > 1000) throw std::invalid_argument("disc: rings must be from 1 to 1000");
  std::vector<Eigen::Vector2d> points;
  for (int i = 1; i <= rings; ++i) {
    const double r = radius_m * RingRadius(i, rings);
    const int on_ring = 4 * (2 * i - 1);
    for (int k = 0; k < on_ring; ++k) {
      const double angle = i * kTurn_rad + k * 2.0 * std::numbers::pi / on_ring;
      points.emplace_back(r * std::cos(angle), r * std::sin(angle));
    }
  }
  return points;
}

PupilEdge EdgeOfDisc(double radius_m, int rings) {
  return {radius_m * RingRadius(rings, rings), radius_m / rings, 1.0 / radius_m};
}

double Reach(double radius_m, int rings) {
  return radius_m * (RingRadius(rings, rings) + 1.0 / rings);
}

}  // namespace twinbench::optics
