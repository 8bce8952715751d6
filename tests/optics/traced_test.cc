#include <gtest/gtest.h>

#include <random>

#include "tests/optics/example_bench.h"

// Light that Embree traces against the formula of its one way, and what only traced light can show.
namespace twinbench::optics {
namespace {

using Eigen::AngleAxisd, Eigen::Isometry3d, Eigen::Translation3d, Eigen::Vector3d;

constexpr double kNanometre = 1e-9;

class LightDice {
 public:
  explicit LightDice(unsigned seed) : random_(seed) {}
  double Within(double half) { return std::uniform_real_distribution<double>(-half, half)(random_); }
  double From(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool Coin() { return Within(1.0) > 0.0; }

 private:
  std::mt19937_64 random_;
};

Isometry3d RandomPose(LightDice& dice) {
  Isometry3d pose(Translation3d(dice.Within(1e-4), dice.Within(1e-4), dice.Within(1e-4)));
  for (const int axis : {2, 1, 0}) pose.rotate(AngleAxisd(dice.Within(1000.0 * kArcsec), Vector3d::Unit(axis)));
  return pose;
}

PsdParameters RandomPsd(LightDice& dice) {
  PsdParameters psd = ExamplePsd();
  psd.distance_m = dice.From(0.08, 0.2);
  psd.roll_rad = dice.Within(1.5);
  psd.tilt_u_rad = dice.Within(0.2);
  psd.tilt_v_rad = dice.Within(0.2);
  psd.cubic_per_m2 = dice.Within(1000.0);
  psd.stray_fraction = dice.From(0.0, 0.01);
  if (dice.Coin()) psd.silicon_reflectance = dice.From(0.0, 0.3);
  if (dice.Coin()) {
    psd.window = Glass(dice.Within(3e-3));
    psd.window->reflectance = dice.From(0.0, 0.05);
    psd.window->coherent = dice.Coin();
  }
  return psd;
}

RotaryOpticsParameters RandomBench(LightDice& dice) {
  RotaryOpticsParameters p = ExampleBench();
  p.grating.lines_per_m = dice.From(300e3, 1000e3);
  p.laser_position_m = {dice.Within(1e-3), dice.From(0.1, 0.4), dice.Within(1e-3)};
  p.psd_a = RandomPsd(dice);
  p.psd_b = RandomPsd(dice);
  if (dice.Coin()) {
    p.beam.kind = BeamKind::kGaussian;
    p.beam.radius_m = dice.From(0.1e-3, 1e-3);
    p.beam.divergence_rad = dice.From(0.0, 1e-3);
  }
  return p;
}

SourceState RandomSource(LightDice& dice) {
  return {650e-9 + dice.Within(2e-9), dice.Within(2e-3), dice.Within(2e-3), 5e-3};
}

RotaryOpticsParameters Closed(RotaryOpticsParameters p) {
  p.fidelity = Fidelity::kClosed;
  return p;
}

void ExpectSame(const PsdSignal& traced, const PsdSignal& closed) {
  ASSERT_EQ(traced.status, closed.status);
  EXPECT_NEAR(traced.power_W, closed.power_W, 1e-9 * closed.power_W);
  if (closed.status != PsdStatus::kOk) return;
  EXPECT_NEAR(traced.u_m, closed.u_m, kNanometre);
  EXPECT_NEAR(traced.v_m, closed.v_m, kNanometre);
}

TEST(TracedLight, AgreesWithTheClosedFormToANanometreOnAnyBench) {
  LightDice dice(15);
  int valid = 0;
  for (int bench = 0; bench < 200; ++bench) {
    SCOPED_TRACE(bench);
    const RotaryOpticsParameters parameters = RandomBench(dice);
    const RotaryOptics traced(parameters), closed(Closed(parameters));
    for (int k = 0; k < 5; ++k) {
      const Isometry3d X_LG = RandomPose(dice);
      const SourceState source = RandomSource(dice);
      const PsdSignals by_rays = traced.Trace(X_LG, source), by_formula = closed.Trace(X_LG, source);
      // A beam of which the formula cuts something off is none that it knows to a nanometre.
      if (by_formula.a.status == PsdStatus::kClipped || by_formula.b.status == PsdStatus::kClipped) continue;
      ExpectSame(by_rays.a, by_formula.a);
      ExpectSame(by_rays.b, by_formula.b);
      valid += by_formula.a.status == PsdStatus::kOk && by_formula.b.status == PsdStatus::kOk;
    }
    EXPECT_GT(traced.rays_traced(), 0u);
    EXPECT_EQ(closed.rays_traced(), 0u);
  }
  EXPECT_GT(valid, 500);
}

TEST(TracedLight, OfManyReadingsHasTheBitsOfOne) {
  LightDice dice(7);
  RotaryOpticsParameters parameters = ExampleBench();
  // In the way of some poses only.
  const Isometry3d pose(Translation3d(0.06 * 0.39, 0.06 * std::sqrt(1 - 0.39 * 0.39), 2e-3));
  for (const bool rides : {false, true})
    parameters.blockers.push_back({BoxMesh({-2e-3, -2e-3, -2e-3}, {2e-3, 2e-3, 2e-3}), pose, rides});
  const RotaryOptics optics(parameters);
  std::vector<Isometry3d> poses;
  std::vector<SourceState> sources;
  for (int k = 0; k < 100; ++k) {
    poses.push_back(RandomPose(dice));
    sources.push_back(RandomSource(dice));
  }
  const std::vector<PsdSignals> together = optics.Trace(poses, sources);
  int dark = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const PsdSignals alone = optics.Trace(poses[k], sources[k]);
    EXPECT_EQ(together[k].a.status, alone.a.status);
    EXPECT_EQ(together[k].b.u_m, alone.b.u_m);
    EXPECT_EQ(together[k].b.power_W, alone.b.power_W);
    dark += alone.a.status == PsdStatus::kNoLight;
  }
  EXPECT_GT(dark, 10);
  EXPECT_LT(dark, 90);
  EXPECT_THROW(optics.Trace(poses, std::span(sources).first(3)), std::invalid_argument);
}

IrradianceMap DarkMap(int pixels, double pitch_m) {
  IrradianceMap map{.width = pixels, .height = pixels, .pitch_m = pitch_m};
  map.irradiance_W_m2.assign(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels), 0.0f);
  return map;
}

float& Pixel(IrradianceMap& map, int row, int column) {
  return map.irradiance_W_m2[static_cast<std::size_t>(row) * static_cast<std::size_t>(map.width) +
                             static_cast<std::size_t>(column)];
}

RotaryOpticsParameters WithProfile(const IrradianceMap& map, double divergence_rad = 0.0) {
  RotaryOpticsParameters p = ExampleBench();
  p.beam = {.kind = BeamKind::kProfile, .divergence_rad = divergence_rad, .profile = map};
  return p;
}

/// Two pixels of equal light, 0.45 mm above and below the axis.
IrradianceMap TwoLobes() {
  IrradianceMap map = DarkMap(20, 0.1e-3);
  Pixel(map, 5, 9) = Pixel(map, 5, 10) = Pixel(map, 14, 9) = Pixel(map, 14, 10) = 1.0f;
  return map;
}

TEST(MeasuredBeam, OnALinearDetectorHasTheCentroidOfItsSecondMoments) {
  LightDice dice(3);
  for (const bool has_window : {false, true}) {
    IrradianceMap map = DarkMap(32, 40e-6);  // as many places as the closed form tells apart
    for (float& value : map.irradiance_W_m2) value = static_cast<float>(dice.From(0.0, 1.0));
    RotaryOpticsParameters parameters = WithProfile(map, 0.5e-3);
    if (has_window) parameters.psd_a.window = Glass(2e-3);
    const RotaryOptics traced(parameters), closed(Closed(parameters));
    for (int k = 0; k < 20; ++k) {
      const Isometry3d X_LG = RandomPose(dice);
      const SourceState source = RandomSource(dice);
      ExpectSame(traced.Trace(X_LG, source).a, closed.Trace(X_LG, source).a);
      ExpectSame(traced.Trace(X_LG, source).b, closed.Trace(X_LG, source).b);
    }
  }
}

void ExpectHalf(const RotaryOpticsParameters& parameters, double v_m) {
  const PsdSignal a = RotaryOptics(parameters).Trace(Isometry3d::Identity(), ExampleSource()).a;
  EXPECT_EQ(a.status, PsdStatus::kClipped);
  EXPECT_NEAR(a.v_m, v_m, 1e-12);
  EXPECT_NEAR(a.power_W, 0.5 * 0.339 * 5e-3, 1e-12);
}

TEST(MeasuredBeam, LosesTheLobeThatFallsBesideTheDetectorOrThatAFixtureCovers) {
  // The upper lobe falls 0.55 mm above the active area, the lower one into its middle.
  RotaryOpticsParameters beside = WithProfile(TwoLobes()), covered = beside;
  beside.psd_a.height_m = 0.7e-3;
  beside.laser_position_m.z() = 0.45e-3;  // lobes at 0.9 mm and 0
  ExpectHalf(beside, 0.0);
  // By its second moments the beam is one broad spot, of which the detector keeps something else.
  EXPECT_GT(std::abs(RotaryOptics(Closed(beside)).Trace(Isometry3d::Identity(), ExampleSource()).a.v_m), 50e-6);
  covered.blockers = {{BoxMesh({-5e-3, 0.01, 0.0}, {5e-3, 0.012, 5e-3}), Isometry3d::Identity(), true}};
  ExpectHalf(covered, -0.45e-3);
}

TEST(MeasuredBeam, IsCutThroughItsPixelsByArea) {
  RotaryOpticsParameters parameters = WithProfile(TwoLobes());
  parameters.psd_a.height_m = 0.9e-3;  // edges in the middle of both lobes' pixels, from 0.40 to 0.50 mm
  ExpectHalf(parameters, 0.0);
  parameters.laser_position_m.z() = 0.025e-3;  // a quarter of a pixel upwards
  const PsdSignal shifted = RotaryOptics(parameters).Trace(Isometry3d::Identity(), ExampleSource()).a;
  // A quarter is left of the upper lobe, between 0.425 and 0.450, three of the lower one, between -0.450 and
  // -0.375.
  EXPECT_NEAR(shifted.v_m, 0.25 * 0.4375e-3 - 0.75 * 0.4125e-3, 1e-12);
}

TEST(MeasuredBeam, MeetsANonLinearDetectorPixelByPixel) {
  IrradianceMap map = DarkMap(20, 0.1e-3);
  Pixel(map, 5, 10) = 3.0f;   // v = 0.45 mm
  Pixel(map, 17, 10) = 1.0f;  // v = -0.75 mm
  RotaryOpticsParameters parameters = WithProfile(map);
  parameters.psd_a.cubic_per_m2 = 1e4;
  const PsdSignal a = RotaryOptics(parameters).Trace(Isometry3d::Identity(), ExampleSource()).a;
  const double u = -0.05e-3 * std::sqrt(1 - 0.39 * 0.39);
  // The mean of v (1 + c (u^2 + v^2)) over a pixel of 0.1 mm, which is shorter along u by the cosine.
  const double half_v = 0.05e-3, half_u = half_v * std::sqrt(1 - 0.39 * 0.39);
  const auto shown = [=](double v) {
    return v * (1.0 + 1e4 * (u * u + v * v + half_u * half_u / 3.0 + half_v * half_v));
  };
  EXPECT_NEAR(a.v_m, 0.75 * shown(0.45e-3) + 0.25 * shown(-0.75e-3), 1e-12);
  const auto aside = [=](double v) {  // the same of u: the beam's x is -x_L
    return u * (1.0 + 1e4 * (u * u + v * v + half_u * half_u + half_v * half_v / 3.0));
  };
  EXPECT_NEAR(a.u_m, 0.75 * aside(0.45e-3) + 0.25 * aside(-0.75e-3), 1e-12);
}

TEST(MeasuredBeam, GatheredToFewerRaysKeepsItsCentroid) {
  LightDice dice(4);
  IrradianceMap map = DarkMap(64, 20e-6);
  for (float& value : map.irradiance_W_m2) value = static_cast<float>(dice.From(0.0, 1.0));
  RotaryOpticsParameters parameters = WithProfile(map, 0.5e-3);
  parameters.psd_a.cubic_per_m2 = parameters.psd_b.cubic_per_m2 = 1000.0;
  RotaryOpticsParameters few = parameters;
  few.beam.profile_rays = 256;
  const Isometry3d X_LG = RandomPose(dice);
  const PsdSignals all = RotaryOptics(parameters).Trace(X_LG, ExampleSource());
  const PsdSignals gathered = RotaryOptics(few).Trace(X_LG, ExampleSource());
  EXPECT_NEAR(all.a.u_m, gathered.a.u_m, kNanometre);
  EXPECT_NEAR(all.b.v_m, gathered.b.v_m, kNanometre);
}

TEST(MeasuredBeam, BehindAnInterferingWindowMovesAsAGaussianBeamDoes) {
  // A Gaussian beam as a picture: each pixel has its own phase, and together they give the closed form's mean of
  // the Airy function. Pixels of a tenth of the beam's deviation: 1e-3 of the shift.
  constexpr double kSigma = 0.25e-3;
  IrradianceMap map = DarkMap(100, kSigma / 10.0);
  for (int row = 0; row < 100; ++row) {
    for (int column = 0; column < 100; ++column) {
      const double r2 = std::pow(map.U(column), 2) + std::pow(map.V(row), 2);
      Pixel(map, row, column) = static_cast<float>(std::exp(-0.5 * r2 / (kSigma * kSigma)));
    }
  }
  RotaryOpticsParameters profile = WithProfile(map), gaussian = ExampleBench();
  gaussian.beam = {.kind = BeamKind::kGaussian, .radius_m = 2.0 * kSigma, .divergence_rad = 0.0, .profile = {}};
  gaussian.fidelity = Fidelity::kClosed;
  double largest = 0.0;
  for (double thickness_m = 1e-3; thickness_m < 1e-3 + 0.3e-6; thickness_m += 0.05e-6) {  // over a fringe
    Window window = Glass(50.0 * kArcsec);
    window.coherent = true;
    window.thickness_m = thickness_m;
    profile.psd_a.window = gaussian.psd_a.window = window;
    const double by_pixels = RotaryOptics(profile).Trace(Isometry3d::Identity(), ExampleSource()).a.u_m;
    const double by_formula = RotaryOptics(gaussian).Trace(Isometry3d::Identity(), ExampleSource()).a.u_m;
    EXPECT_NEAR(by_pixels, by_formula, 0.02e-6);
    largest = std::max(largest, std::abs(by_formula));
  }
  EXPECT_GT(largest, 2e-6);
}

TEST(MeasuredBeam, IsPicturedOnTheDetectorAsItFallsThere) {
  const RotaryOptics optics(WithProfile(TwoLobes()));
  const Isometry3d X_LG(AngleAxisd(100.0 * kArcsec, Vector3d::UnitZ()));
  const std::vector<IrradianceMap> maps = optics.Irradiance(X_LG, ExampleSource(), 400);
  const PsdSignals signals = optics.Trace(X_LG, ExampleSource());
  EXPECT_NEAR(Centroid(maps[0]).u_m, signals.a.u_m, 0.5e-6);  // pixels of 25 um, cut by area
  EXPECT_NEAR(Centroid(maps[0]).v_m, signals.a.v_m, 0.5e-6);
  EXPECT_NEAR(Centroid(maps[1]).power_W, signals.b.power_W, 1e-9);
  const int column = static_cast<int>((signals.a.u_m + 5e-3) / 25e-6);
  EXPECT_EQ(maps[0].At(200, column), 0.0f);           // between the lobes
  EXPECT_GT(maps[0].At(200 - 18, column), 0.0f);      // 0.45 mm above
  EXPECT_EQ(maps[0].At(200 - 18, column - 8), 0.0f);  // beside it
}

}  // namespace
}  // namespace twinbench::optics
