#include <gtest/gtest.h>

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
  IrradianceMap map{.width = 64, .height = 48, .pitch_m = 20e-6};
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

Spot Gaussian(double u_m, double v_m, double sigma_m) {
  return {.u_m = u_m, .v_m = v_m, .power_W = 1.0, .cov_m2 = sigma_m * sigma_m * Eigen::Matrix2d::Identity()};
}

/// Centroid and power of a Gaussian with any covariance on a rectangle, by brute force on a fine grid.
Spot Integrate(const Spot& spot, double width_m, double height_m) {
  const int n = 1500;
  const Eigen::Matrix2d precision = spot.cov_m2.inverse();
  double sum = 0.0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const Eigen::Vector2d p(((i + 0.5) / n - 0.5) * width_m, ((j + 0.5) / n - 0.5) * height_m);
      const Eigen::Vector2d r = p - Eigen::Vector2d(spot.u_m, spot.v_m);
      const double density = std::exp(-0.5 * r.dot(precision * r));
      sum += density;
      moment += density * p;
    }
  }
  const double cell = width_m * height_m / (n * n);
  const double norm = 2.0 * std::numbers::pi * std::sqrt(spot.cov_m2.determinant());
  return {.u_m = moment.x() / sum, .v_m = moment.y() / sum, .power_W = spot.power_W * sum * cell / norm};
}

TEST(Truncate, HasTheTextbookShiftsOfASpotNearAnEdge) {
  // sigma 0.25 mm, edge at k sigma: -sigma phi / Phi.
  const struct {
    double k, shift_um, tolerance_um;  // half the last digit that is given
  } rows[] = {{3.0, -1.11, 0.005}, {3.5, -0.22, 0.005}, {4.0, -0.033, 0.0005}, {5.0, -3.7e-4, 0.05e-4}};
  for (const auto& row : rows) {
    const double u = 5e-3 - row.k * 0.25e-3;
    EXPECT_NEAR((Truncate(Gaussian(u, 0.0, 0.25e-3), 0.01, 0.01).u_m - u) * 1e6, row.shift_um, row.tolerance_um);
  }
}

TEST(Truncate, AgreesWithNumericalIntegrationAlsoOfAnInclinedEllipseOverOneEdge) {
  Spot inclined = Gaussian(4.8e-3, 0.0, 0.3e-3);
  inclined.cov_m2 << 9e-8, 3e-8, 3e-8, 5e-8;
  std::vector<Spot> spots = {inclined};
  for (const double u : {0.0, 4.2e-3, 5.0e-3, 5.4e-3, -4.8e-3}) spots.push_back(Gaussian(u, 0.3e-3, 0.4e-3));
  for (const Spot& spot : spots) {
    const Spot exact = Integrate(spot, 0.01, 0.01), cut = Truncate(spot, 0.01, 0.01);
    // Midpoint rule, h = 7 um, sigma = 0.4 mm: h^2 / (24 sigma^2) = 1e-5 of a millimetre, of the power likewise.
    EXPECT_NEAR(cut.u_m, exact.u_m, 2e-8);
    EXPECT_NEAR(cut.v_m, exact.v_m, 2e-8);
    EXPECT_NEAR(cut.power_W, exact.power_W, 1e-5);
  }
}

TEST(Respond, CallsASpotOverTheEdgeClippedAndOneBesideMissed) {
  const PsdParameters psd = ExamplePsd();
  const auto status = [&](double u_m) {
    const Spot spot = Gaussian(u_m, 0.0, 0.25e-3);
    return Respond(psd, {&spot, 1}).status;
  };
  EXPECT_EQ(status(0.0), PsdStatus::kOk);
  EXPECT_EQ(status(4.5e-3), PsdStatus::kClipped);  // 2 sigma from the edge
  EXPECT_EQ(status(8.0e-3), PsdStatus::kMissed);
  const Spot dark{};
  EXPECT_EQ(Respond(psd, {&dark, 1}).status, PsdStatus::kNoLight);
  EXPECT_TRUE(std::isnan(Respond(psd, {&dark, 1}).u_m));
}

TEST(Respond, StretchesByTheCubeOfTheDistanceAndStrayLightPullsToTheCentreAndAddsPower) {
  PsdParameters cubic = ExamplePsd(), stray = cubic;
  cubic.cubic_per_m2 = 100.0;
  stray.stray_fraction = 0.02;
  const PsdSignal stretched = RespondToPoint(cubic, 3e-3, 4e-3, 1.0);
  EXPECT_NEAR(stretched.u_m, 3e-3 * (1.0 + 100.0 * 25e-6), 1e-17);
  EXPECT_NEAR(stretched.v_m, 4e-3 * (1.0 + 100.0 * 25e-6), 1e-17);
  const Spot spot = Gaussian(1e-3, -2e-3, 0.1e-3);
  const PsdSignal pulled = Respond(stray, {&spot, 1});
  EXPECT_NEAR(pulled.u_m, 1e-3 / 1.02, 1e-17);
  EXPECT_NEAR(pulled.v_m, -2e-3 / 1.02, 1e-17);
  EXPECT_NEAR(pulled.power_W, 1.02, 1e-15);
}

TEST(Respond, WeighsPatchesWithTheirPowerAndTakesAPointAsAPatch) {
  const Spot spots[] = {{.u_m = 1e-3, .v_m = 0.0, .power_W = 3.0}, {.u_m = -1e-3, .v_m = 2e-3, .power_W = 1.0}};
  const PsdSignal signal = Respond(ExamplePsd(), spots);
  EXPECT_NEAR(signal.u_m, 0.5e-3, 1e-18);
  EXPECT_NEAR(signal.v_m, 0.5e-3, 1e-18);
  PsdParameters psd = ExamplePsd();
  psd.cubic_per_m2 = 50.0;
  psd.stray_fraction = 0.01;
  const PsdSignal a = RespondToPoint(psd, 1e-3, 0.0, 3.0), b = Respond(psd, {spots, 1});
  EXPECT_EQ(a.u_m, b.u_m);
  EXPECT_EQ(a.power_W, b.power_W);
}

TEST(Psd, RefusesMissingParameters) {
  EXPECT_THROW(Validate(PsdParameters{}), std::invalid_argument);
  PsdParameters psd = ExamplePsd();
  psd.window = Window{};
  EXPECT_THROW(Validate(psd), std::invalid_argument);
}

}  // namespace
}  // namespace twinbench::optics
