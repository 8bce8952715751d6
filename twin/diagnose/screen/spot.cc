#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr std::array<int, 4> kDegrees = {2, 3, 4, 5};
constexpr double kShortestPeriod_m = 20e-6;  // shorter ones change within the spread of a stop
constexpr int kMostHalfFringes = 80;

/// Own and cross coordinate of each channel as the model places the spot; a channel without a spot has none.
struct Coordinates {
  std::vector<Eigen::VectorXd> own_m, cross_m;  // by channel
};

Coordinates CoordinatesOf(const LinearRun& run, const std::vector<Spot>& spots) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(run.schedule.Readings());
  Coordinates u{std::vector(run.channels.size(), none), std::vector(run.channels.size(), none)};
  for (const Spot& spot : spots) {
    const auto x = static_cast<std::size_t>(spot.x), y = static_cast<std::size_t>(spot.y);
    u.own_m[x] = u.cross_m[y] = Predicted(run, spot.x);
    u.own_m[y] = u.cross_m[x] = Predicted(run, spot.y);
  }
  return u;
}

/// Legendre polynomials of kDegrees side by side, by the three-term recurrence.
Eigen::MatrixXd Polynomials(const Eigen::VectorXd& u) {
  Eigen::MatrixXd p(u.size(), kDegrees.back() + 1);
  p.col(0).setOnes();
  p.col(1) = u;
  for (int n = 1; n < kDegrees.back(); ++n) {
    p.col(n + 1) = ((2 * n + 1) * u.cwiseProduct(p.col(n)) - n * p.col(n - 1)) / (n + 1);
  }
  return p.rightCols(std::ssize(kDegrees));
}

void TestPolynomials(const Sample& s, const Coordinates& u, Tests& tests) {
  Scan scan;
  ScanWords words{"spot: polynomial", {}, "a detector that is not linear: pincushion, tilt, edge, converter"};
  for (std::size_t c = 0; c < u.own_m.size(); ++c) {
    Eigen::MatrixXd both(s.run.schedule.Readings(), 2 * std::ssize(kDegrees));
    both << Polynomials(Normalised(u.own_m[c])), Polynomials(Normalised(u.cross_m[c]));
    scan.shapes.push_back(std::move(both));
  }
  for (const char* which : {"own", "cross"}) {
    for (int n : kDegrees) words.items.push_back(fmt::format("degree {} of the spot's {} coordinate", n, which));
  }
  Keep(TestScan(s, scan, words), tests);
}

/// Frequencies in steps of half a fringe over the range: a fringe between two of them stays within a quarter turn.
std::vector<double> FringesPerMetre(const Coordinates& u) {
  double range_m = 0.0;
  for (const Eigen::VectorXd& own_m : u.own_m) range_m = std::max(range_m, own_m.maxCoeff() - own_m.minCoeff());
  const int halves = static_cast<int>(std::min<double>(kMostHalfFringes, 2.0 * range_m / kShortestPeriod_m));
  std::vector<double> fringes;
  for (int k = 4; k <= halves; ++k) fringes.push_back(0.5 * k / range_m);
  return fringes;
}

void TestFringes(const Sample& s, const Coordinates& u, Tests& tests) {
  const std::vector<double> fringes = FringesPerMetre(u);
  if (fringes.empty()) return;
  Scan scan{{}, 2};
  ScanWords words{"spot: periodic", {}, "interference fringes of a window, steps of a converter"};
  for (const Eigen::VectorXd& own_m : u.own_m) {
    Eigen::MatrixXd shapes(own_m.size(), 2 * std::ssize(fringes));
    for (std::size_t k = 0; k < fringes.size(); ++k) {
      const Eigen::ArrayXd phase = 2.0 * std::numbers::pi * fringes[k] * own_m.array();
      shapes.col(2 * static_cast<Eigen::Index>(k)) = phase.cos();
      shapes.col(2 * static_cast<Eigen::Index>(k) + 1) = phase.sin();
    }
    scan.shapes.push_back(std::move(shapes));
  }
  for (double f : fringes)
    words.items.push_back(fmt::format("the spot's own coordinate with a period of {:.3g} um", 1e6 / f));
  Keep(TestScan(s, scan, words), tests);
}

}  // namespace

Tests TestSpot(const Sample& sample) {
  Tests tests;
  const std::vector<Spot> spots = SpotsOf(sample.run);
  if (spots.empty()) return tests;
  const Coordinates u = CoordinatesOf(sample.run, spots);
  TestPolynomials(sample, u, tests);
  TestFringes(sample, u, tests);
  return tests;
}

}  // namespace twinbench::diagnose::screen
