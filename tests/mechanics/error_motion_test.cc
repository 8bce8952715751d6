#include "mechanics/error_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "tests/mechanics/test_units.h"

namespace twinbench::mechanics {
namespace {

std::function<double()> Normals(unsigned seed) {
  return [engine = std::mt19937_64(seed), normal = std::normal_distribution<double>()]() mutable {
    return normal(engine);
  };
}

TEST(ErrorMotion, SumsHarmonicsOfAnyOrderAndUnwrappedAngle) {
  const std::vector<Harmonic> harmonics = {{0, 1, 2e-5, 0.3},  {0, 2, 1e-5, -1.0},   {2, 12, 3e-6, 2.0},
                                           {2, 13, 1e-6, 0.1}, {4, 7.25, 2e-6, 0.5}, {5, 0, 4e-6, 0.7},
                                           {1, -3, 1e-6, 0.2}};
  const ErrorMotion motion(harmonics);
  EXPECT_EQ(ErrorMotion().Evaluate(1.0).Array(), (std::array<double, kErrorComponents>{}));
  EXPECT_EQ(PoseError::FromArray(motion.Evaluate(0.7).Array()).Array(), motion.Evaluate(0.7).Array());
  EXPECT_EQ((PoseError{1, 2, 3, 4, 5, 6}.Array()[3]), 4);
  for (double angle : {0.0, 0.7, -2.1, 40.0, -63.2}) {
    std::array<double, kErrorComponents> expected{};
    for (const Harmonic& h : harmonics)
      expected[static_cast<std::size_t>(h.component)] += h.amplitude * std::cos(h.order * angle + h.phase_rad);
    const auto found = motion.Evaluate(angle).Array();
    // 1e-5 times the rounding of an argument of 800 rad: 1e-5 x 1e-13
    for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(found[c], expected[c], 1e-17);
  }
}

TEST(ErrorMotion, MeetsTheTableExactlyAtItsAnglesAlsoAtOneOrTwo) {
  ErrorTable table;
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> uniform(-1e-5, 1e-5);
  for (int i = 0; i < 36; ++i) {
    table.angle_rad.push_back(i * 10.0 * kDegree);
    for (std::size_t c : {0u, 2u, 4u}) table.value[c].push_back(uniform(engine));
  }
  const ErrorMotion motion({}, table);
  for (std::size_t i = 0; i < 36; ++i) {
    for (int turn : {-3, 0, 2}) {
      const auto e = motion.Evaluate(table.angle_rad[i] + 2.0 * kPi * turn).Array();
      // Slope 1e-4 times the rounding of the wrapped angle, 4e-15
      for (std::size_t c : {0u, 2u, 4u}) EXPECT_NEAR(e[c], table.value[c][i], 1e-18);
      for (std::size_t c : {1u, 3u, 5u}) EXPECT_EQ(e[c], 0.0);
    }
  }
  ErrorTable one{{1.0}, {}};
  one.value[5] = {3e-6};
  // A constant; h^3 M terms cancel to rounding of 3e-6.
  EXPECT_NEAR(ErrorMotion({}, one).Evaluate(2.5).dz_m, 3e-6, 1e-20);
  ErrorTable two{{0.0, kPi}, {}};
  two.value[5] = {1e-6, -1e-6};
  EXPECT_NEAR(ErrorMotion({}, two).Evaluate(kPi).dz_m, -1e-6, 1e-20);
  EXPECT_NEAR(ErrorMotion({}, two).Evaluate(0.5 * kPi).dz_m, 0.0, 1e-20);  // antisymmetric
}

TEST(ErrorMotion, InterpolatesASmoothTableWithUnequalSteps) {
  ErrorTable table;
  for (int i = 0; i < 72; ++i) {
    table.angle_rad.push_back((5.0 * i + (i % 3)) * kDegree);
    table.value[1].push_back(std::sin(3.0 * table.angle_rad.back()));
  }
  const ErrorMotion motion({}, table);
  double worst = 0.0;
  for (int i = 0; i < 3600; ++i)
    worst = std::max(worst, std::abs(motion.Evaluate(0.1 * i * kDegree).ey_rad - std::sin(0.3 * i * kDegree)));
  // Cubic splines: 5/384 h^4 f'''' = 5/384 x (6 deg)^4 x 81 = 1.3e-4
  EXPECT_LT(worst, 1.3e-4);
  EXPECT_GT(worst, 1e-6);  // but it is an interpolation
}

TEST(ErrorMotion, RefusesTablesThatMakeNoSense) {
  ErrorTable twice{{0.0, 2.0 * kPi}, {}};
  twice.value[0] = {1.0, 2.0};
  EXPECT_THROW(ErrorMotion({}, twice), std::invalid_argument);
  ErrorTable shorter{{0.0, 1.0}, {}};
  shorter.value[0] = {1.0};
  EXPECT_THROW(ErrorMotion({}, shorter), std::invalid_argument);
  EXPECT_THROW(ErrorMotion({{6, 1.0, 1.0, 0.0}}), std::invalid_argument);
}

TEST(ErrorMotion, HalfFrequencyMotionDiffersBetweenTurnsAndRepeatsAfterTwo) {
  const ErrorMotion motion({}, {}, {0.5, 2.0 * kArcsec, 0.3 * kMicrometre});
  const PoseError first = motion.Evaluate(1.0);
  const PoseError second = motion.Evaluate(1.0 + 2.0 * kPi);
  const PoseError third = motion.Evaluate(1.0 + 4.0 * kPi);
  EXPECT_NEAR(second.ex_rad, -first.ex_rad, 1e-20);  // half a turn of the whirl; 1e-5 x rounding of pi
  EXPECT_NEAR(third.dy_m, first.dy_m, 1e-20);
  EXPECT_NEAR(std::hypot(first.ex_rad, first.ey_rad), 2.0 * kArcsec, 1e-20);  // circular
  EXPECT_NEAR(std::hypot(first.dx_m, first.dy_m), 0.3 * kMicrometre, 1e-20);
}

TEST(RandomHarmonics, HaveExactlyTheRmsAskedForFallAsOneOverOrderAndDoNotDependOnOtherComponents) {
  const std::array<double, kErrorComponents> rms = {2e-5, 1e-5, 0.0, 1e-6, 2e-6, 3e-7};
  const ErrorMotion motion(MakeRandomHarmonics(rms, 12, Normals(1)));
  std::array<double, kErrorComponents> square{};
  for (int i = 0; i < 100; ++i) {
    const auto e = motion.Evaluate(2.0 * kPi * i / 100.0).Array();
    for (std::size_t c = 0; c < 6; ++c) square[c] += e[c] * e[c] / 100.0;
  }
  // 100 equally spaced angles integrate products of orders up to 12 exactly.
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(std::sqrt(square[c]), rms[c], 1e-14 * rms[c]);

  double low = 0.0;
  double high = 0.0;
  const auto normal = Normals(2);
  for (int i = 0; i < 2000; ++i) {
    const auto harmonics = MakeRandomHarmonics({1e-5, 0, 0, 0, 0, 0}, 4, normal);
    low += harmonics[0].amplitude * harmonics[0].amplitude;
    high += harmonics[3].amplitude * harmonics[3].amplitude;
  }
  // Order 4 has 1/16 of the power of order 1 before scaling; the scaling correlates with order 1 and lifts the
  // ratio towards 0.1; a factor of two either way tells it from white (1) and from 1/k^2 (1/256).
  EXPECT_GT(high / low, 0.05);
  EXPECT_LT(high / low, 0.2);
  const auto all = MakeRandomHarmonics({1e-5, 1e-5, 0, 0, 0, 1e-6}, 5, Normals(3));
  const auto one = MakeRandomHarmonics({0, 0, 0, 0, 0, 1e-6}, 5, Normals(3));
  EXPECT_EQ(one.back().amplitude, all.back().amplitude);
  EXPECT_EQ(one.back().phase_rad, all.back().phase_rad);
}

}  // namespace
}  // namespace twinbench::mechanics
