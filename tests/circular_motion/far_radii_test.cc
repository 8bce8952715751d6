#include "tests/circular_motion/written_circles.h"
#include "twin/benches/circular_motion/bench.h"
#include "twin/benches/circular_motion/estimators/far_radii.h"
#include "twin/benches/evaluated.h"
#include "twin/core/stream.h"

// One reading that is far off is no form of a circle, and what every turn shows is none that is far off.
namespace twinbench::benches::circular {
namespace {

using separate::FarOnCourse, separate::circular::TakeOutFar;
using units::deg, units::mm, units::um;

constexpr double kFarCircle_m = 120.0 * mm;

/// A degree apart, 2.5 um cos 4a and more, with a noise of 0.1 um.
template <class More_m>
std::vector<Reading> TurnsEachWay(int turns, const More_m& more_m) {
  Stream noise(11, "bar");
  return WithAngles(test::Written({kFarCircle_m, 0.02, 360, 0.4, 0.0, 360.0 * turns}, [&](Reading& r, double a) {
    kBar_m(r) = 2.5 * um * std::cos(4.0 * a) + 0.1 * um * noise.Normal() + more_m(r.position, r.direction);
  }));
}

TEST(FarRadii, ASingleOneIsTakenOutWithItsPlace) {
  std::vector<Reading> readings = TurnsEachWay(1, [](int k, int way) { return k == 217 && way < 0 ? -40.0 * um : 0.0; });
  const std::vector<FarOnCourse> far = TakeOutFar(readings);
  ASSERT_EQ(far.size(), 1U);
  EXPECT_EQ(far[0].reading, 360 + 217);
  EXPECT_NEAR(std::remainder(far[0].angle_rad / deg + 217.4, 360.0), 0.0, 1e-6);
  EXPECT_NEAR(far[0].off / um, -40.0, 0.8);  // five of its noise with that of its neighbours, 0.14 um
  EXPECT_EQ(readings.size(), 719U);
}

TEST(FarRadii, WhatEveryTurnShowsAStepAndWhatFollowsAReversalStay) {
  std::vector<Reading> each = TurnsEachWay(2, [](int k, int) { return k % 360 == 130 ? 15.0 * um : 0.0; });
  EXPECT_TRUE(TakeOutFar(each).empty());
  std::vector<Reading> step = TurnsEachWay(1, [](int k, int way) { return k > 200 && way > 0 ? 15.0 * um : 0.0; });
  EXPECT_TRUE(TakeOutFar(step).empty());
  std::vector<Reading> reversal = TurnsEachWay(1, [](int k, int) { return k == 91 ? 15.0 * um : 0.0; });
  EXPECT_TRUE(TakeOutFar(reversal).empty());
}

TEST(FarRadii, ACircularDeviationIsWithoutThem) {
  const std::vector<Reading> readings = TurnsEachWay(1, [](int k, int way) { return k == 300 && way > 0 ? 60.0 * um : 0.0; });
  const Scenario scenario = test::ToldOfCircles("radial_bar", kFarCircle_m);
  const nlohmann::json results = EvaluationOf(scenario, readings, Estimator::kRigorous).results;
  // 5 um, and by two extremes of about 60 readings each of the noise: 4.6 x 0.1 um.
  EXPECT_NEAR(results.at("iso230_4").at(0).at("G_ccw_um").get<double>(), 5.3, 0.4);
  EXPECT_EQ(results.at("far").at(0).at("reading"), 300);
  EXPECT_EQ(results.at("left_out"), 1);
}

TEST(CircleLogs, OfManyReadingsAreDiagnosedByAPartWithAllReversals) {
  constexpr int kRows = 9000;
  const std::vector<Reading> readings =
      test::Written({kFarCircle_m, 0.05, kRows / 3, 0.5, 0.0, 1080.0}, [](Reading& r, double) {
        kGridX_m(r) = kCommandedX_m(r);
        kGridY_m(r) = kCommandedY_m(r);
      });
  const diagnose::LinearRun run =
      Linear(readings, test::ToldOfCircles("drive", kFarCircle_m), Estimator::kRigorous);
  EXPECT_LT(run.schedule.Readings(), 2200);
  for (int quarter = 1; quarter < 12; ++quarter)  // an axis turns round at each
    for (int k = quarter * kRows / 12 - 5; k < quarter * kRows / 12 + 5; ++k) EXPECT_EQ(std::ranges::count(run.schedule.reading, k), 1) << k;
}

}  // namespace
}  // namespace twinbench::benches::circular
