#include "optics/beam.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/optics/example_bench.h"

namespace twinbench::optics {
namespace {

double Average(const BeamNodes& nodes, double (*f)(const BeamNode&)) {
  double sum = 0.0;
  for (const BeamNode& node : nodes) sum += node.weight * f(node);
  return sum;
}

TEST(GaussianBundle, HasTheMomentsOfTheBeamAndSpreadsAsItDoes) {
  const BeamNodes nodes = GaussianBundle(0.5e-3, 1e-3, 3);
  EXPECT_EQ(nodes.size(), 81u);
  EXPECT_NEAR(Average(nodes, [](const BeamNode&) { return 1.0; }), 1.0, 1e-14);
  EXPECT_NEAR(Average(nodes, [](const BeamNode& n) { return n.x_m * n.x_m; }), 0.0625e-6, 1e-20);
  EXPECT_NEAR(Average(nodes, [](const BeamNode& n) { return n.slope_y * n.slope_y; }), 0.25e-6, 1e-20);
  EXPECT_NEAR(Average(nodes, [](const BeamNode& n) { return n.x_m * n.slope_x; }), 0.0, 1e-20);
  // w(z)^2 = w0^2 + (divergence z)^2, 2 m away.
  const double variance = Average(GaussianBundle(0.5e-3, 1e-3, 2),
                                  [](const BeamNode& n) { return std::pow(n.x_m + 2.0 * n.slope_x, 2); });
  EXPECT_NEAR(2.0 * std::sqrt(variance), std::hypot(0.5e-3, 2e-3), 1e-15);
  const BeamNodes dense = DenseBundle(0.5e-3, 1e-3, 24);
  EXPECT_NEAR(Average(dense, [](const BeamNode& n) { return n.x_m; }), 0.0, 1e-15);
  EXPECT_NEAR(Average(dense, [](const BeamNode& n) { return n.x_m * n.x_m; }), 0.0625e-6, 0.002e-6);  // slices: 3 %
  EXPECT_NEAR(Average(dense, [](const BeamNode& n) { return n.slope_x * n.slope_x; }), 0.25e-6, 1e-18);
}

IrradianceMap Slope() {
  IrradianceMap map;
  map.width = 64;
  map.height = 48;
  map.pitch_m = 20e-6;
  for (int row = 0; row < 48; ++row) {
    for (int column = 0; column < 64; ++column)
      map.irradiance_W_m2.push_back(static_cast<float>(1 + column + 2 * row));
  }
  return map;
}

TEST(ProfileBundle, RefusesADarkMap) {
  IrradianceMap map = Slope();
  for (float& value : map.irradiance_W_m2) value = 0.0f;
  EXPECT_THROW(ProfileBundle(map, 0.0, 100), std::invalid_argument);
}

TEST(AxesAcross, AreRightHandedWithTheLight) {
  const BeamAxes axes = AxesAcross({0, -1, 0});
  EXPECT_LT((axes.x - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-16);
  EXPECT_LT((axes.y - Eigen::Vector3d(0, 0, 1)).norm(), 1e-16);
}

/// Landing place on a plane perpendicular to the nominal order, for slopes (a, b) of a ray through the origin of
/// the laser at distance `h`; the grating turned by `alpha`. Written in components, apart from the library.
double LandingPlace(double x, double a, double b, double alpha, double h, double l) {
  const double norm = std::sqrt(1 + a * a + b * b);
  // Beam x points along -x_L; the light runs along -y_L.
  const double dx = -a / norm, dy = -1 / norm, dz = b / norm;
  const double ny = std::cos(alpha), nx = -std::sin(alpha), gx = std::cos(alpha), gy = std::sin(alpha);
  const double ox = -x, t = -(ox * nx + h * ny) / (dx * nx + dy * ny);
  const double px = ox + t * dx, py = h + t * dy;
  const double across = dx * gx + dy * gy + 0.39, out = std::sqrt(1 - across * across - dz * dz);
  const double kx = across * gx + out * nx, ky = across * gy + out * ny;
  const double s = 0.39, c = std::sqrt(1 - s * s);
  const double t2 = (l - px * s - py * c) / (kx * s + ky * c);
  return (px + t2 * kx) * c - (py + t2 * ky) * s;
}

/// Mean over the beam by Simpson's rule in both slopes over +-8 sigma (linear in x, so x = 0 is its mean).
double SimpsonMean(double sigma, double alpha, double h, double l) {
  const int n = 120;
  double sum = 0.0, weight = 0.0;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double a = -8.0 + 16.0 * i / n, b = -8.0 + 16.0 * j / n;
      const double simpson = (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * (j == 0 || j == n ? 1 : j % 2 ? 4 : 2);
      const double w = simpson * std::exp(-0.5 * (a * a + b * b));
      sum += w * LandingPlace(0.0, sigma * a, sigma * b, alpha, h, l);
      weight += w;
    }
  }
  return sum / weight;
}

TEST(GaussianBundle, GivesTheCentroidOfTheWholeBeamAfterTheGrating) {
  for (const double divergence : {0.5e-3, 2e-3, 5e-3}) {
    RotaryOpticsParameters parameters = ExampleBench();
    parameters.beam = {
        .kind = BeamKind::kGaussian, .radius_m = 0.5e-3, .divergence_rad = divergence, .profile = {}};
    const double alpha = 300 * kArcsec;
    const Eigen::Isometry3d X_LG(Eigen::AngleAxisd(alpha, Eigen::Vector3d::UnitZ()));
    const auto spots = RotaryOptics(parameters).Spots(X_LG, ExampleSource());
    const double exact = SimpsonMean(divergence / 2, alpha, 0.2, 0.12);
    // Demanded: 1 nm. The rule's own error is of fourth order in the slopes: 1e-3^4 of 0.3 m.
    EXPECT_NEAR(spots[0][0].u_m, exact, 1e-11);
    const double chief = LandingPlace(0, 0, 0, alpha, 0.2, 0.12);
    EXPECT_GT(std::abs(exact - chief),
              5e-10 * std::pow(divergence / 0.5e-3, 2));  // there is something to get right
  }
}

}  // namespace
}  // namespace twinbench::optics
