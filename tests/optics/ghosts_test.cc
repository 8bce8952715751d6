#include "optics/ghosts.h"

#include <gtest/gtest.h>

#include "tests/optics/example_bench.h"

namespace twinbench::optics {
namespace {

using Eigen::AngleAxisd, Eigen::Isometry3d, Eigen::Vector3d;

/// A detector 150 mm from the spot and what is traced on it; only detector A has the faults under test.
struct Set {
  RotaryOpticsParameters parameters = ExampleBench();
  Isometry3d X_LG = Isometry3d::Identity();
  GhostOptions options{};

  Set() { parameters.psd_a.distance_m = parameters.psd_b.distance_m = 0.150; }

  std::vector<Deposit> Trace() const {
    const RotaryOptics optics(parameters);
    const GhostBench bench{.X_LG = X_LG, .grating = &parameters.grating, .wavelength_m = 650e-9,
                           .psd = {&parameters.psd_a, &parameters.psd_b}, .X_LP = {optics.X_LA(), optics.X_LB()},
                           .blocked = {}};
    return TraceGhosts(bench, optics.ChiefRay(ExampleSource()), 1.0, options);
  }
};

std::vector<Deposit> Select(const std::vector<Deposit>& all, int detector, int order, int reflections) {
  std::vector<Deposit> some;
  std::ranges::copy_if(all, std::back_inserter(some), [=](const Deposit& d) {
    return d.detector == detector && d.order == order && d.reflections == reflections;
  });
  return some;
}

TEST(TraceGhosts, ShiftsTheSpotByATiltedPlate) {
  const auto shift = [](double tilt_rad) {
    Set set;
    set.parameters.psd_a.tilt_v_rad = tilt_rad;
    const double bare = Select(set.Trace(), 0, 1, 0).at(0).u_m;
    set.parameters.psd_a.window = Glass();
    return Select(set.Trace(), 0, 1, 0).at(0).u_m - bare;
  };
  const double tilt = 1.0 * kDegree, inside = std::asin(std::sin(tilt) / 1.5145);
  // 5.93 um per degree; in the plane of the tilted detector t (tan theta - tan theta').
  EXPECT_NEAR(std::abs(shift(tilt)), 5.93e-6, 0.01e-6);
  EXPECT_NEAR(std::abs(shift(tilt)), 1e-3 * (std::tan(tilt) - std::tan(inside)), 1e-15);
  EXPECT_NEAR(shift(0.0), 0.0, 1e-16);
}

TEST(TraceGhosts, FindsTheGhostsInsideTheWindowAndBetweenItAndTheSilicon) {
  Set set;
  set.parameters.psd_a.tilt_v_rad = 1.0 * kDegree;
  set.parameters.psd_a.window = Glass();
  const std::vector<Deposit> inside = set.Trace();
  const Deposit direct = Select(inside, 0, 1, 0).at(0), ghost = Select(inside, 0, 1, 2).at(0);
  const auto pull = [](const Deposit& d, const Deposit& to) {
    return std::abs(d.u_m - to.u_m) * d.power_W / to.power_W;
  };
  EXPECT_NEAR(std::abs(ghost.u_m - direct.u_m), 23e-6, 0.1e-6);       // 2 t tan(theta')
  EXPECT_NEAR(ghost.power_W / direct.power_W, 0.042 * 0.042, 1e-12);  // 0.18 %
  EXPECT_NEAR(pull(ghost, direct), 0.041e-6, 0.0005e-6);
  set.parameters.psd_a.silicon_reflectance = 0.3;
  const std::vector<Deposit> all = set.Trace();
  const Deposit main = Select(all, 0, 1, 0).at(0);
  const auto off = [&](const Deposit& d) {
    return std::abs(std::abs(d.u_m - main.u_m) - 2e-3 * std::tan(1.0 * kDegree));
  };
  const std::vector<Deposit> twice = Select(all, 0, 1, 2);
  const Deposit nearest = *std::ranges::min_element(twice, {}, off);
  EXPECT_LT(off(nearest), 1e-12);                       // lands 2 gap tan(theta) beside the direct spot
  EXPECT_NEAR(pull(nearest, main), 0.44e-6, 0.005e-6);  // R_silicon R_face of it
}

TEST(TraceGhosts, ReturnsTheLightOfAReflectingDetectorByWayOfTheGrating) {
  Set set;
  set.parameters.psd_a.silicon_reflectance = 0.1;
  // A normal detector: light goes back on itself, orders 2 and 0 of the second meeting land on both detectors'
  // centres.
  for (const int detector : {0, 1}) {
    const std::vector<Deposit> ghosts = Select(set.Trace(), detector, 1, 1);
    ASSERT_EQ(ghosts.size(), 1u);
    EXPECT_NEAR(ghosts[0].u_m, 0.0, 1e-15);
  }
  const double step = 1.0 * kArcsec;
  const double main_0 = Select(set.Trace(), 0, 1, 0).at(0).u_m, ghost_0 = Select(set.Trace(), 0, 1, 1).at(0).u_m;
  set.X_LG = Isometry3d(AngleAxisd(step, Vector3d::UnitZ()));
  const double main_1 = Select(set.Trace(), 0, 1, 0).at(0).u_m, ghost_1 = Select(set.Trace(), 0, 1, 1).at(0).u_m;
  EXPECT_NEAR(std::abs(main_1 - main_0), 1.517e-6, 0.5e-9);
  EXPECT_NEAR(std::abs(ghost_1 - ghost_0), 6.0e-6, 0.07e-6);  // four times as sensitive
}

TEST(TraceGhosts, LosesTheRoundTripGhostWhenTheDetectorIsTilted) {
  Set set;
  set.parameters.psd_a.silicon_reflectance = 0.1;
  set.parameters.psd_a.width_m = 40e-3;  // large, to see where the ghost goes
  set.parameters.psd_a.tilt_v_rad = 0.5 * kDegree;
  const std::vector<Deposit> ghosts = Select(set.Trace(), 0, 1, 1);
  ASSERT_EQ(ghosts.size(), 1u);
  EXPECT_NEAR(std::abs(ghosts[0].u_m), 5.2e-3, 0.1e-3);  // just off a 10 mm detector
}

TEST(TraceGhosts, NeverMakesLight) {
  Set set;
  for (PsdParameters* psd : {&set.parameters.psd_a, &set.parameters.psd_b}) {
    psd->silicon_reflectance = 0.3;
    psd->window = Glass();
  }
  set.options = {.max_reflections = 6, .threshold = 1e-12};
  double sum = 0.0;
  for (const Deposit& d : set.Trace()) sum += d.power_W;
  EXPECT_LT(sum, 0.978);  // what the grating sends into all orders
  EXPECT_GT(sum, 2 * 0.339 * 0.958 * 0.958 * 0.7);
}

TEST(TraceGhosts, DropsWeakAndDeepPaths) {
  Set set;
  set.parameters.psd_a.silicon_reflectance = 0.3;
  set.options.max_reflections = 0;
  EXPECT_EQ(set.Trace().size(), 2u);
  set.options = {.max_reflections = 5, .threshold = 1e-9};
  const std::size_t many = set.Trace().size();
  set.options.threshold = 1e-3;
  EXPECT_LT(set.Trace().size(), many);
}

TEST(TraceGhosts, MakesTheScaleErrorThatOneKnowsFromTheStudy) {
  // 1 % relative ghost power moves the centroid by 1 % of (6.0 - 1.517) / 1.517 = 3 % of the signal.
  RotaryOpticsParameters parameters = ExampleBench();
  parameters.psd_a.distance_m = parameters.psd_b.distance_m = 0.150;
  const auto u = [&](double angle) {
    const Isometry3d X_LG(AngleAxisd(angle, Vector3d::UnitZ()));
    return RotaryOptics(parameters).Trace(X_LG, ExampleSource()).a.u_m;
  };
  const double clean = u(kArcsec) - u(0.0);
  // Reflectance 0.1, then order 2 with 0.1, which takes its part of the now evanescent order -2 (0.978 / 0.878).
  parameters.psd_a.silicon_reflectance = 0.1;
  parameters.ghosts.max_reflections = 1;  // a second round trip adds another 0.001
  const double relative = 0.1 * 0.1 * 0.978 / 0.878;
  // Two digits of 6.0 um: 1 % of the effect.
  EXPECT_NEAR((u(kArcsec) - u(0.0)) / clean - 1.0, relative / (1.0 + relative) * (6.0 / 1.517 - 1.0), 0.0007);
}

TEST(RotaryOptics, PicksTheSameAnswerOnTheFullPathWhenNothingReflects) {
  RotaryOpticsParameters parameters = ExampleBench();
  const Isometry3d X_LG(AngleAxisd(50 * kArcsec, Vector3d(1, 2, 3).normalized()));
  const PsdSignals fast = RotaryOptics(parameters).Trace(X_LG, ExampleSource());
  parameters.psd_a.silicon_reflectance = 1e-12;  // below the threshold, but enough to trace every path
  const PsdSignals full = RotaryOptics(parameters).Trace(X_LG, ExampleSource());
  EXPECT_NEAR(fast.a.u_m, full.a.u_m, 1e-16);
  EXPECT_NEAR(fast.b.v_m, full.b.v_m, 1e-16);
  EXPECT_NEAR(fast.a.power_W / full.a.power_W, 1.0, 1e-11);
}

}  // namespace
}  // namespace twinbench::optics
