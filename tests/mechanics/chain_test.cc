#include <random>

#include "mechanics/error_motion.h"
#include "mechanics/sag.h"
#include "tests/mechanics/plant_runs.h"

namespace twinbench::mechanics {
namespace {

double Tilt(const Vector12& q, int table) { return q.segment<2>(kPerTable * table + 3).norm(); }

TEST(StaticDeflection, FollowsTheFirstOrderFormula) {
  const Vector12 q = StaticDeflection(EccentricStack(), 0.3, -1.0);
  const double moment_Nm = 1.5 * 9.81 * 0.040;
  // m g r/k = 0.202 and 0.486 arcsec; the deflected masses add their leaning weight, about 1e-4 + 1e-4 of it.
  EXPECT_NEAR(Tilt(q, 0) / kArcsec, moment_Nm / 0.60e6 / kArcsec, 6e-4);
  EXPECT_NEAR(Tilt(q, 1) / kArcsec, moment_Nm / 0.25e6 / kArcsec, 6e-4);
  EXPECT_NEAR(Tilt(q, 0) / kArcsec, 0.202, 1e-3);
  EXPECT_NEAR(Tilt(q, 1) / kArcsec, 0.486, 1e-3);
  EXPECT_NEAR(q[2], -1.5 * 9.81 / 200e6, 1e-12);  // the payload's weight; the rest is preloaded
  EXPECT_NEAR(q[8], -1.5 * 9.81 / 120e6, 1e-12);
}

TEST(StaticDeflection, LeansTowardsThePayloadAndIsExactlyZeroForAStackThatIsOnlyItself) {
  StackParameters p = EccentricStack();
  p.payload.azimuth_rad = 0.5 * kPi;  // on +y: weight turns about +x, top comes down towards +y
  const Vector12 q = StaticDeflection(p, 0.0, 0.0);
  EXPECT_LT(q[3], 0.0);
  EXPECT_NEAR(q[4], 0.0, 1e-18);
  EXPECT_TRUE(SagIsConstant(StackParameters{}));
  EXPECT_EQ(StaticDeflection({}, 0.0, 0.0).cwiseAbs().maxCoeff(), 0.0);
}

TEST(WeightGradient, IsTheSlopeOfTheWeightsEnergyInTheChain) {
  StackParameters p = EccentricStack();
  p.geometry.centring_m = {1e-3, -2e-3};
  p.geometry.mount_tilt_rad = {1e-2, 2e-2};
  p.geometry.reseat_rad = 0.4;
  p.payload.azimuth_rad = 0.8;
  Vector12 q;
  q << 1e-3, -2e-3, 3e-3, 1e-2, -2e-2, 0.5, 2e-3, 1e-3, -1e-3, -1e-2, 3e-2, -1.1;
  const Chain chain(p.geometry);
  const auto energy = [&](const Vector12& at) {
    ChainState s{.target_rad = at[SpinIndex(0)], .reference_rad = at[SpinIndex(1)],
                 .target_bearing = BearingOf(at, 0), .reference_bearing = BearingOf(at, 1)};
    const Pose X_LT = chain.TargetRotorPose(s);
    const Pose X_LR = chain.ReferenceRotorPose(s);
    Pose X_TS = Pose::Identity();
    X_TS.linear() = (Eigen::AngleAxisd(2e-2, Vector3::UnitY()) * Eigen::AngleAxisd(1e-2, Vector3::UnitX()) *
                     Eigen::AngleAxisd(0.4, Vector3::UnitZ()))
                        .toRotationMatrix();
    X_TS.translation() << 1e-3, -2e-3, 0.08;
    const Vector3 p_RP(0.04 * std::cos(0.8), 0.04 * std::sin(0.8), 0.05);
    return 9.81 * (12.0 * X_LT.translation().z() + 9.0 * (X_LT * X_TS * Vector3(0, 0, -0.03)).z() +
                   6.0 * X_LR.translation().z() + 1.5 * (X_LR * p_RP).z());
  };
  const Vector12 slope = WeightGradient(p, q);
  for (int i = 0; i < kCoordinates; ++i) {
    const Vector12 h = 1e-5 * Vector12::Unit(i);
    // Central difference: energy 30 J rounds to 4e-15 J over 2e-5; third derivatives 30 x 1e-10/6
    EXPECT_NEAR(slope[i], (energy(q + h) - energy(q - h)) / 2e-5, 1e-8) << "coordinate " << i;
  }
}

TEST(Chain, EqualsTheProductOfItsFactorsForEveryInput) {
  ChainGeometry g{.p_RG_m = Vector3(0.01, 0.03, 0.05), .centring_m = {20e-6, -30e-6},
                  .mount_tilt_rad = {1e-4, -2e-4}, .reseat_rad = -0.7, .clamp_rad = 0.3};
  ChainState s{.target_rad = 1.1, .reference_rad = -2.3, .target_error = {1e-5, 2e-5, -3e-5, 1e-6, 2e-6, 3e-6},
               .reference_error = {-2e-5, 1e-5, 4e-5, -3e-6, 1e-6, 2e-6},
               .target_bearing = {1e-6, 2e-6, -3e-6, 2e-6, -5e-6},
               .reference_bearing = {-2e-6, 1e-6, -1e-6, 3e-6, 1e-6}, .goniometer_yaw_rad = 1e-3,
               .goniometer_tilt_rad = -2e-3};

  using Eigen::AngleAxisd;
  using Eigen::Translation3d;
  const Vector3 x = Vector3::UnitX();
  const Vector3 y = Vector3::UnitY();
  const Vector3 z = Vector3::UnitZ();
  const auto bearing = [&](const BearingPose& b) {
    return Translation3d(b.x_m, b.y_m, b.z_m) * AngleAxisd(b.rx_rad, x) * AngleAxisd(b.ry_rad, y);
  };
  const auto error = [&](const PoseError& e) {
    return Translation3d(e.dx_m, e.dy_m, e.dz_m) * AngleAxisd(e.ez_rad, z) * AngleAxisd(e.ey_rad, y) *
           AngleAxisd(e.ex_rad, x);
  };
  const Eigen::Rotation2Dd turn(s.reference_rad);
  PoseError base = s.reference_error;
  const Eigen::Vector2d tilt = turn * Eigen::Vector2d(base.ex_rad, base.ey_rad);
  const Eigen::Vector2d radial = turn * Eigen::Vector2d(base.dx_m, base.dy_m);
  base = {tilt.x(), tilt.y(), base.ez_rad, radial.x(), radial.y(), base.dz_m};
  const Eigen::Affine3d expected = Eigen::Affine3d(AngleAxisd(s.goniometer_yaw_rad, z)) *
                                   AngleAxisd(s.goniometer_tilt_rad, x) * Translation3d(-0.01, -0.03, -0.13) *
                                   bearing(s.target_bearing) * error(s.target_error) * AngleAxisd(s.target_rad, z) *
                                   Translation3d(20e-6, -30e-6, 0.08) * AngleAxisd(-2e-4, y) * AngleAxisd(1e-4, x) *
                                   AngleAxisd(-0.7, z) * bearing(s.reference_bearing) * error(base) *
                                   AngleAxisd(s.reference_rad, z) * AngleAxisd(-0.3, z) * Translation3d(g.p_RG_m);
  // Two orders of multiplying a dozen matrices of size one: 1e-15 each.
  EXPECT_LT((Chain(g).GratingPose(s).matrix() - expected.matrix()).norm(), 5e-15);
}

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
