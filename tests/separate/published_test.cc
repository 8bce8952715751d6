#include <Eigen/LU>
#include <numeric>

#include "tests/separate/bench.h"
#include "tests/support/oracle_poses.h"
#include "tests/support/truth_rows.h"
#include "twin/benches/rotary_4dof/estimators/chain.h"
#include "twin/benches/rotary_4dof/estimators/grating_model.h"
#include "twin/benches/rotary_4dof/estimators/published.h"
#include "twin/core/errors.h"

namespace twinbench::separate {
namespace {

/// rms over the positions of the target's noise for unit noise on every reading.
double TargetGain(int n) {
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  const Eigen::MatrixXd map = SolvePublished(I.topRows(n), I.bottomRows(n));
  const Eigen::MatrixXd centred = map.topRows(n).rowwise() - map.topRows(n).colwise().mean();
  return std::sqrt(centred.squaredNorm() / n);
}

TEST(SolvePublished, IsRootTwoNoisierThanLeastSquares) {
  // The dropped row is the closing difference of a random walk (docs/theory.md 2).
  for (const int n : {12, 36}) EXPECT_NEAR(TargetGain(n), std::sqrt(2.0 * (n * n - 1.0) / (6.0 * n)), 1e-9) << n;
}

constexpr Component kWobble[] = {Component::kEx, Component::kEy};

Truth ReferenceHarmonic(int n, int k) {
  Truth truth{ZeroErrors(n), ZeroErrors(n)};
  for (std::size_t j = 0; j < truth.reference.position_rad.size(); ++j) {
    truth.reference[Component::kEx][j] = 1e-7 * std::cos(k * truth.reference.position_rad[j]);
    truth.reference[Component::kEy][j] = 1e-7 * std::sin(k * truth.reference.position_rad[j]);
  }
  return truth;
}

/// rms of the wobble error of the target, of an amplitude of 1.
double WobbleError(int n, int k, Clamping clamping) {
  auto motions = EmptyMotions(n, {0, 1}, 1, ReadingCovariance());
  FillExact(motions, ReferenceHarmonic(n, k), Layouts(n, clamping), Bench());
  const Separation found = SeparatePublished(motions, Bench(), Layouts(n, clamping));
  double sum = 0.0;
  for (const Component c : kWobble) {
    for (const double v : found.target.value[c]) sum += v * v;
  }
  return std::sqrt(sum / n) / 1e-7;
}

TEST(SeparatePublished, GetsReferenceWobbleWrongByOneOverItsOrderAfterReclampingAndIsRightAfterReseating) {
  const std::vector<std::pair<int, double>> expected = {{1, 1.00}, {2, 0.502}, {3, 0.337}, {5, 0.206}, {10, 0.114}};
  for (const auto& [k, relative] : expected) {
    for (const int sign : {1, -1}) {
      // Three printed digits (docs/theory.md 3.1); wobble of 1e-7 rad keeps second order away.
      EXPECT_NEAR(WobbleError(36, sign * k, Clamping::kReclamp), relative, 6e-4) << sign * k;
    }
  }
  for (const int k : {1, 2, 5, -3}) EXPECT_LT(WobbleError(36, k, Clamping::kReseat), 1e-6);  // second order
}

TEST(SeparatePublished, AgreesWithTheTruthOfAScalarWorld) {
  const ExactCircles c = ReadExactly(36, {0, 1}, Clamping::kReseat, 2, FlatBench());
  const Separation found = SeparatePublished(c.motions, FlatBench(), Layouts(36, Clamping::kReseat));
  for (const test::SeparatedTable& t : test::BothTables(found, c.truth)) {
    // Second order of 5 arcsec wobble, amplified by up to n / pi: 1e-3 arcsec; the limit leaves a factor of 20.
    for (const Component k : {Component::kEx, Component::kEy, Component::kEz})
      EXPECT_LT(t.RmsError(k), 0.02 * units::arcsec) << t.Name(k);
  }
}

TEST(SeparatePublished, StatesTheNoiseOfItsElimination) {
  const auto motions = EmptyMotions(36, {0, 1}, 1, Matrix4::Identity());
  const Separation found = SeparatePublished(motions, Bench(), Layouts(36, Clamping::kReseat));
  double sum = 0.0;
  for (const double u : found.target.u[Component::kEx]) sum += u * u;
  // Means removed before the elimination: the closing difference is spread, the random walk becomes a bridge.
  EXPECT_GT(std::sqrt(sum / 36.0), 2.4);
  EXPECT_LT(std::sqrt(sum / 36.0), 3.47);
}

TEST(SeparatePublished, NeedsTwoSetUpsOneStepApart) {
  const auto motions = EmptyMotions(12, {0, 4}, 1, Matrix4::Identity());
  EXPECT_THROW(SeparatePublished(motions, Bench(), Layouts(12, Clamping::kReseat)), InputError);
}

using nlohmann::json;

const std::string kOracle = std::string(TWINBENCH_TEST_DATA) + "/oracle/full_circle_";

Truth OracleTruth(const std::string& mode) {
  const json truth = test::ReadTruthFile(kOracle + mode + "_truth.json");
  return {test::ErrorsOfRows(truth.at("target"), false),
          test::ErrorsOfRows(truth.at("reference_rotor_frame"), true)};
}

Separation SeparateOracle(const std::string& mode) {
  const auto readings = ReadReadingsCsv(kOracle + mode + ".csv");
  const auto motions = measure::Measure(readings, Bench(), measure::Calibration{}, Estimator::kRigorous);
  return Separate(motions, Bench(), Options(36, mode == "reclamp" ? Clamping::kReclamp : Clamping::kReseat));
}

class Oracle : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Modes, Oracle, testing::Values("reclamp", "reseat"));

TEST_P(Oracle, ComesBackWithZeroMeanAndWithinTheUncertaintyOfARunWithoutNoise) {
  const Separation found = SeparateOracle(GetParam());
  double largest = 0.0;
  for (const test::SeparatedTable& t : test::BothTables(found, OracleTruth(GetParam()))) {
    for (const Component c : t.estimate.components) {
      // The acceptance limit of the bench; what is left is third order and the nine digits of the files.
      EXPECT_LT(t.RmsError(c), IsAngle(c) ? 0.02 * units::arcsec : 0.02 * units::um) << t.Name(c);
      largest = std::max(largest, t.ErrorOverU(c));
      const std::vector<double>& values = t.estimate.value[c];
      EXPECT_NEAR(std::accumulate(values.begin(), values.end(), 0.0), 0.0, 1e-16);  // 36 values of 1e-5: rounding
    }
  }
  EXPECT_LT(found.residual_rms.head<3>().maxCoeff(), 0.01 * units::arcsec);
  // The second-order terms nobody reads are known by size only: of order 1, within three.
  EXPECT_LT(largest, 3.0);
  EXPECT_GT(largest, 0.1);
}

TEST(OracleRuns, OfReclampGivesBothRadialComponentsOfTheReferenceAndReseatOnlyOne) {
  const json reclamp = ToJson(SeparateOracle("reclamp")), reseat = ToJson(SeparateOracle("reseat"));
  EXPECT_EQ(reclamp["reference"].count("dx_um"), 1u);
  EXPECT_EQ(reseat["reference"].count("dx_um"), 0u);
  EXPECT_EQ(reclamp["target"].count("dx_um"), 0u);
  EXPECT_EQ(reseat["target"]["position_deg"].size(), 36u);
  EXPECT_NEAR(reseat["target"]["position_deg"][35].get<double>(), 350.0, 1e-9);  // rounding
}

/// The oracle's poses give the reference's error in its base frame.
Vector6 ToRotorFrame(Vector6 e, double reference_rad) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(-reference_rad).toRotationMatrix();
  e.head<2>() = turn * e.head<2>();
  e.segment<2>(3) = turn * e.segment<2>(3);
  return e;
}

TEST(GratingPose, PutsTheSpotsWhereTheIndependentOraclePutsThem) {
  const auto poses = test::OraclePoses();
  ASSERT_GE(poses.size(), 100u);
  for (const test::OraclePose& pose : poses) {
    const bool reclamp = pose.is_reclamped;
    const Stop stop{pose.target_rad, pose.reference_rad, reclamp ? 0.0 : -pose.shift_rad,
                    reclamp ? pose.shift_rad : 0.0};
    PoseErrors errors{.target = Eigen::Map<const Vector6>(pose.target.data()),
                      .reference = ToRotorFrame(Eigen::Map<const Vector6>(pose.reference.data()), stop.reference_rad)};
    const Vector4 spots_m = measure::PredictSpots(MotionOf(GratingPose(stop, errors, Bench())), Bench());
    // The oracle prints nine digits of a micrometre.
    EXPECT_LT((spots_m - Eigen::Map<const Vector4>(pose.spots_m.data())).cwiseAbs().maxCoeff(), 2e-15) << reclamp;
  }
}

}  // namespace
}  // namespace twinbench::separate
