#include "tests/circular_motion/written_circles.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

// What noise and steps of readings make of the circular deviations, against those of the path itself.
namespace twinbench::separate::circular {
namespace {

using units::deg, units::mm, units::um;

struct Kind {
  double order, noise_um, step_um;
  int readings = 360;
};

/// 3 um cos(order a) about a centre that is some um off, as a bar of this noise and step shows it. Noise is stated as
/// 0.25 um.
CirclePath Shown(const Kind& kind, Stream& stream) {
  const double phase_rad = units::turn * stream.Uniform();
  const Eigen::Vector2d centre_m(7.0 * um * stream.Normal(), 7.0 * um * stream.Normal());
  const auto show = [&](PathPoint& point, const Eigen::Vector2d& outwards) {
    const double lobes_m = kind.order > 0.0 ? 3.0 * um * std::cos(kind.order * point.commanded_rad + phase_rad) : 0.0;
    point.shown_m = centre_m.dot(outwards) + lobes_m + kind.noise_um * um * stream.Normal();
    if (kind.step_um > 0.0) point.shown_m = kind.step_um * um * std::round(point.shown_m / (kind.step_um * um));
    point.d_m = (point.shown_m - centre_m.dot(outwards)) * outwards;
    point.u_own_m = Eigen::Vector2d::Constant(0.25 * um);
  };
  return test::WrittenPath(1, 150.0 * mm, kind.readings, 0.3 * units::turn / kind.readings, show);
}

/// One unknown that is known as good as exactly.
SharedUncertainty NearlyNothing() { return test::SharedLength(1e-6 * um); }

TEST(CircularDeviationNoise, IsInTheUncertaintyWithWhatItMakesExtremesLargerBy) {
  constexpr int kTrials = 20;
  Stream stream(7, "bar");
  int within = 0, all = 0;
  for (const double order : {0.0, 2.0, 5.0}) {
    for (const auto& [noise_um, step_um] : {std::pair{0.0, 0.1}, {0.0, 1.0}, {0.05, 0.0}, {0.1, 1.0}, {0.5, 0.1}, {2.0, 0.0}}) {
      for (int k = 0; k < kTrials; ++k) {
        const Iso230_4 d = CircularDeviations({Shown({order, noise_um, step_um}, stream)}, NearlyNothing())[0];
        const double size_m = order > 0.0 ? 3.0 * um : 0.0;
        for (const auto& [value, of_path_m] : {std::pair{d.G_ccw, 2.0 * size_m}, {d.G_mz_ccw, 2.0 * size_m}, {d.Fmax_ccw, size_m}, {d.Fmin_ccw, -size_m}}) {
          ++all;
          within += std::abs(value.value_m - of_path_m) < 2.0 * value.u_m ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(within, 0.93 * all);
}

TEST(CircularDeviationNoise, IsThatOfTheReadingsAndNotTheOneThatIsStated) {
  Stream stream(8, "bar");
  const auto u_um = [&](const Kind& kind) {
    return CircularDeviations({Shown(kind, stream)}, NearlyNothing())[0].G_ccw.u_m / um;
  };
  // Of pure noise, the largest of n normal deviates at either end: 2.9 deviations for 360, of which some 2.4 are told.
  EXPECT_NEAR(u_um({0.0, 0.02, 0.0}), 0.1, 0.025);
  EXPECT_NEAR(u_um({0.0, 2.0, 0.0}), 10.0, 2.5);
  EXPECT_GT(u_um({0.0, 1.0, 0.0, 3600}), u_um({0.0, 1.0, 0.0, 90}) + 0.5) << "among more readings there are larger extremes";
  EXPECT_GT(u_um({2.0, 0.0, 1.0}), std::sqrt(2.0 / 12.0)) << "steps of 1 um";
}

TEST(CircularDeviationNoise, OfASingleReadingThatIsFarOffIsThatOfTheOthers) {
  Stream stream(9, "bar");
  CirclePath path = Shown({2.0, 0.1, 0.0}, stream);
  path.points[123].d_m = 60.0 * um * path.points[123].slope.col(0);
  const Iso230_4Value far = CircularDeviations({path}, NearlyNothing())[0].Fmax_ccw;
  EXPECT_NEAR(far.u_m / um, 0.1, 0.02) << "no other reading is near it";
}

TEST(CircularDeviationNoise, OfAMeanInCoarseStepsIsNotThatOfSoManyReadings) {
  // 360 readings on the two sides of one step: as good as two rounding errors of half of the readings each.
  const auto show = [](PathPoint& point, const Eigen::Vector2d& outwards) {
    point.shown_m = outwards.y() >= 0.0 ? 0.0 : um;
    point.d_m = point.shown_m * outwards;
    point.u_own_m = Eigen::Vector2d::Constant(0.25 * um);
  };
  const CirclePath there = test::WrittenPath(1, 150.0 * mm, 360, 0.5 * deg, show),
                   back = test::WrittenPath(-1, 150.0 * mm, 360, 0.5 * deg, show);
  const Iso230_4Value d = CircularDeviations({there, back}, NearlyNothing())[0].D;
  EXPECT_NEAR(d.u_m / um, std::sqrt(4.0 / 16.0 / 12.0), 0.02);
}

}  // namespace
}  // namespace twinbench::separate::circular
