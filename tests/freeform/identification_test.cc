#include <gmock/gmock.h>

#include "tests/freeform/freeform_run.h"
#include "tests/support/over_seeds.h"
#include "twin/benches/freeform_five_axis/estimators/identification.h"
#include "twin/benches/freeform_five_axis/estimators/volumetric.h"

namespace twinbench::freeform_test {
namespace {

using namespace benches::freeform::estimators;

/// The oracle's machine as unknowns of a run of four set-ups.
Eigen::VectorXd UnknownsOf(const sim::DrawnBench& bench) {
  Eigen::VectorXd x(MountingAt(static_cast<int>(bench.mountings.size()), 0));
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    for (std::size_t error = 0; error < kBodyErrors; ++error) {
      for (std::size_t term = 0; term < kCubicTerms; ++term)
        x[CubicAt(static_cast<int>(axis), static_cast<int>(error), static_cast<int>(term))] = bench.machine.errors[axis][error][term];
    }
  }
  for (int k = 0; k < kSquarenesses; ++k)
    x[SquarenessAt(k)] = bench.machine.squareness_rad[static_cast<std::size_t>(k)];
  for (std::size_t setup = 0; setup < bench.mountings.size(); ++setup) {
    for (int k = 0; k < kBodyErrors; ++k)
      x[MountingAt(static_cast<int>(setup), k)] = bench.mountings[setup][static_cast<std::size_t>(k)];
  }
  for (int k = 0; k < x.size(); ++k) x[k] /= UnitOf(k);
  return x;
}

TEST(FreeformEstimator, PredictsWhatTheTwinShows) {
  // Written down twice, one by equations and one by rays: to what tracing leaves in a double.
  const FreeformSettings settings;
  const std::vector<Reading> readings = OracleRun();
  const Eigen::VectorXd x = UnknownsOf(OracleBench());
  sim::FreeformTwin twin(FreeformScenario(), OracleBench());
  const std::vector<PoseRead> poses = PosesOf(readings, settings);
  ASSERT_EQ(poses.size(), readings.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d predicted = Predicted(settings, poses[i], InputsAt(poses[i], x));
    const sim::ProbeSignals shown = twin.Show(readings[i], 0.0);
    EXPECT_NEAR(predicted[0], shown.qpd_x_V, 1e-8);
    EXPECT_NEAR(predicted[1], shown.qpd_y_V, 1e-8);
    EXPECT_NEAR(predicted[2], shown.ccd_px, 1e-8);
  }
}

TEST(FreeformEstimator, Finds114Of151UnknownsOnTheStandardPath) {
  const Scenario scenario = FreeformScenario();
  std::vector<PoseRead> poses = PosesOf(RunOf(scenario), FreeformOf(scenario));
  const Identification found = Identify(FreeformOf(scenario), poses);
  EXPECT_TRUE(found.converged);
  EXPECT_FALSE(found.lone);
  EXPECT_EQ(found.unknowns.size(), 151);
  EXPECT_EQ(found.rank, 114);
  EXPECT_EQ(found.not_separable.size(), 37u);
  EXPECT_GT(found.singular_values[113], 2.0 * found.singular_values[114]) << "a clear step at the limit of 3e-4";
  // Noise alone is left: 10 mV and 0.05 px, each from some 800 readings, of which 114 / 3 unknowns take 2 %.
  EXPECT_NEAR(found.residual_rms[0], 0.010, 0.0006);
  EXPECT_NEAR(found.residual_rms[1], 0.010, 0.0006);
  EXPECT_NEAR(found.residual_rms[2], 0.050, 0.004);

  poses[400].shown[1] += 0.15;
  const auto lone = Identify(FreeformOf(scenario), poses).lone;
  ASSERT_TRUE(lone);
  EXPECT_EQ(lone->reading, poses[400].reading);
  EXPECT_EQ(lone->channel, 1);
  EXPECT_NEAR(lone->times, 15.0, 4.0);  // the fit gives way a little, and noise comes on top
}

TEST(FreeformEstimator, LeavesNothingOfTheOraclesRunAndPredictsItsUnseenPoses) {
  const FreeformSettings settings;
  const std::vector<Reading> readings = OracleRun();
  const Identification found = Identify(settings, PosesOf(readings, settings));
  EXPECT_TRUE(found.converged);
  const CsvTable table = ReadCsv(OraclePath("unseen.csv"));
  Eigen::Matrix3Xd points(3, std::ssize(table.rows)), off_um = points;
  const Eigen::VectorXd ideal = Eigen::VectorXd::Zero(found.unknowns.size());
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    PoseRead pose;
    for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
      pose.at[axis] = CsvNumber(table, table.rows[i], axis, axis < 3 ? units::mm : units::deg);
      pose.t[axis] = (pose.at[axis] - settings.machine.centre[axis]) / settings.machine.half[axis];
    }
    points.col(column) = estimators::Tip_m(settings, pose, InputsAt(pose, ideal)) / units::um;
    off_um.col(column) =
        estimators::Tip_m(settings, pose, InputsAt(pose, found.unknowns)) / units::um - points.col(column);
    for (int k = 0; k < 3; ++k)
      off_um(k, column) -= CsvNumber(table, table.rows[i], 5 + static_cast<std::size_t>(k), 1.0);
  }
  const Eigen::Matrix3Xd left_um = WithoutRigidMotion(points, off_um);
  // Without noise what is left are the directions below 3e-4 of the largest, which the run hardly shows and unseen
  // poses hardly need.
  EXPECT_LT(left_um.colwise().norm().maxCoeff(), 0.5);
  EXPECT_GT(WithoutRigidMotion(points, points * 1e-5).norm(), 0.0);  // a stretch is no rigid motion
}

TEST(FreeformEstimator, StatesUncertaintiesThatMatchItsScatter) {
  const Eigen::Array2d squares_and_count = test::MeanOverSeeds(6, [](std::uint64_t seed) {
    const Scenario scenario = FreeformScenario("seed = " + std::to_string(seed) + "\n");
    const sim::DrawnBench drawn = sim::Draw(scenario);
    const Identification found =
        Identify(FreeformOf(scenario), PosesOf(RunOf(scenario, drawn), FreeformOf(scenario)));
    EXPECT_TRUE(found.converged) << seed;
    const Eigen::ArrayXd pulls = (found.unknowns - UnknownsOf(drawn)).cwiseQuotient(found.u).head(kOfMachine);
    Eigen::Array2d sums(0.0, 0.0);
    for (Eigen::Index k = 0; k < kOfMachine; ++k)
      if (found.identified[static_cast<std::size_t>(k)]) sums += Eigen::Array2d(std::pow(pulls[k], 2), 1.0);
    return sums;
  });
  ASSERT_GT(squares_and_count[1], 30);
  // Mean square of some hundreds of standard deviations, correlated in a run: 1 within 20 %.
  EXPECT_NEAR(squares_and_count[0] / squares_and_count[1], 1.0, 0.2);
}

/// Where the machine stands is no error of its volume: a shift and a small turn about each axis leave nothing.
TEST(VolumetricErrors, HaveNoneOfTheMotionOfTheWholeMachine) {
  Eigen::Matrix3Xd points(3, 5);
  points << 0.0, 300.0, 0.0, 120.0, -80.0,  //
      10.0, 0.0, 250.0, -60.0, 90.0,        //
      0.0, 40.0, -30.0, 200.0, 150.0;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d turn = 1e-3 * Eigen::Vector3d::Unit(axis), shift(1.0, -2.0, 0.5);
    Eigen::Matrix3Xd moved(3, points.cols());
    for (Eigen::Index k = 0; k < points.cols(); ++k) moved.col(k) = shift + turn.cross(points.col(k));
    EXPECT_LT(WithoutRigidMotion(points, moved).cwiseAbs().maxCoeff(), 1e-12) << "about axis " << axis;
  }
}

constexpr const char* kShorter = "[freeform_procedure]\nposes = 45\n";  // for the time it takes

diagnose::Diagnosis DiagnosisWith(const std::string& hidden) {
  return DiagnosisOf(RunOf(FreeformScenario(kShorter + hidden)), FreeformScenario(kShorter));
}

/// Set-ups are a quarter of an hour apart: what the spindle did in between counts.
TEST(FreeformDiagnosis, SizesGrowthThatLagsBehindTheTemperature) {
  const std::string warm = "[environment]\nswing_mK = 700.0\nswing_period_s = 7000.0\n";
  const diagnose::Diagnosis diagnosis = DiagnosisWith("[[effect]]\nname = \"thermal_growth\"\nwhere = \"y\"\ngrowth_um_K = 4.0\nlag_s = 500.0\n" + warm);
  ASSERT_THAT(NamesOf(diagnosis), testing::ElementsAre("thermal_growth"));
  for (const auto& [name, truth] : {std::pair{"growth", 4e-6}, std::pair{"lag", 500.0}}) {
    const auto& all = diagnosis.causes.front().parameters;
    const auto found = std::ranges::find(all, name, &diagnose::ParameterEstimate::name);
    ASSERT_NE(found, all.end());
    EXPECT_NEAR(found->value, truth, 3.0 * found->u);
    EXPECT_LT(found->u, 0.3 * truth);
  }
}

}  // namespace
}  // namespace twinbench::freeform_test
