#include "tests/core/input_error.h"
#include "tests/scenarios/as_shipped.h"
#include "twin/benches/encoder_comparison/estimators/angle_comparison.h"
#include "twin/benches/rotary_4dof/estimators/stability.h"
#include "twin/plan/next_run.h"

// What happens in a run as a newcomer types it: docs/architecture.md, events and functions of time.
namespace twinbench {
namespace {

struct WatchedRun {
  std::vector<Reading> readings;
  std::map<std::string, std::uint64_t> events;
  std::uint64_t rays = 0;
};

WatchedRun Watched(const Scenario& scenario) {
  sim::Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  test::MemoryLog log;
  procedure::CarryOut(bench, scenario, log);
  return {log.readings, twin.ScheduledEvents(), twin.RaysTraced()};
}

TEST(DefaultRun, SchedulesWhatEveryDeviceDoesAndTracesAllItsLight) {
  const Scenario scenario = LoadScenario(test::ScenarioPath("rotary_4dof.toml"));
  ASSERT_EQ(RotaryOf(scenario).mechanics.fidelity, "bullet");
  ASSERT_EQ(RotaryOf(scenario).optics.fidelity, "traced");
  const WatchedRun run = Watched(scenario);
  std::set<std::pair<Phase, int>> mountings;
  std::uint64_t stops = 0, swept = 0;
  for (const Reading& r : run.readings) {
    mountings.insert({r.phase, r.setup});
    stops += r.phase == Phase::kFullCircle ? 1 : 0;
    swept += std::isfinite(r.autocollimator_yaw_rad) ? 1 : 0;
  }
  ASSERT_EQ(stops, 576U);
  EXPECT_EQ(run.events.at("fixture"), mountings.size());
  EXPECT_EQ(run.events.at("thermometer"), run.readings.size());
  EXPECT_EQ(run.events.at("autocollimator"), swept);
  EXPECT_GE(run.events.at("goniometer"), swept);
  // One end of a profile a move, and for the servos, counted with the target, a step each of the 600 ms and more
  // that a move takes.
  EXPECT_GE(run.events.at("reference"), stops);
  EXPECT_GE(run.events.at("target"), 600 * stops);
  // The floor of a quiet laboratory shakes: three steps in a block of 1.6 ms, the fewest that a cubic needs.
  EXPECT_EQ(run.events.at("adc"), 4 * run.readings.size());
  // The light is found at every knot: the chief ray to the grating, past all that stands in the room, and two
  // orders.
  EXPECT_GE(run.rays, 4 * run.events.at("adc"));
}

// Where nothing moves a block is its begin and its end, and tables that stand where they are sent have no servos.
TEST(DefaultRun, AsksNoMoreWhereNothingIsFast) {
  Scenario scenario = LoadScenario(test::ScenarioPath("rotary_4dof.toml"), {"mechanics.fidelity=kinematic"});
  const WatchedRun run = Watched(scenario);
  EXPECT_EQ(run.events.at("adc"), 2 * run.readings.size());
  EXPECT_LT(run.events.at("target"), 2 * run.readings.size());
}

// Every file in scenarios/ opens with a question and the answer expected; here the answers are checked.

using separate::Separation, separate::Table;

std::vector<std::string> ScenarioNames() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(test::ScenarioPath(""))) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().filename());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class EveryScenario : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryScenario, OpensWithItsQuestionAndTheAnswerExpected) {
  const std::string head = Contents(test::ScenarioPath(GetParam())).substr(0, 600);
  EXPECT_EQ(head.rfind("# Question: ", 0), 0u);
  EXPECT_NE(head.find("\n# Answer:"), std::string::npos);
}

TEST_P(EveryScenario, RunsWithEveryReadingValid) {
  // Bodies at a slow hob take longest of all, each turn like the other.
  const bool is_longest = GetParam() == "hob_drive_orders.toml";
  const test::BenchRun run = is_longest ? test::RunBench(LoadScenario(test::ScenarioPath(GetParam()), {"hob_procedure.turns=1"}))
                                        : test::AsShipped(GetParam());
  EXPECT_EQ(static_cast<int>(run.readings.size()), BenchOf(run.scenario).planned_readings(run.scenario));
  for (const Reading& reading : run.readings) EXPECT_EQ(reading.status, ReadingStatus::kOk) << reading.reading;
}

TEST_P(EveryScenario, AllowsTheRunsThatItsBenchOffersNext) {
  const Scenario scenario = LoadScenario(test::ScenarioPath(GetParam()));
  for (const plan::NextRun& next : BenchOf(scenario).next_runs(scenario))
    EXPECT_NO_THROW(LoadScenario(test::ScenarioPath(GetParam()), next.sets)) << next.name;
}

INSTANTIATE_TEST_SUITE_P(InFolder, EveryScenario, ::testing::ValuesIn(ScenarioNames()), [](const auto& param_info) {
  return param_info.param.substr(0, param_info.param.find('.'));
});

struct Deviation {
  double rms_error = 0.0;  // rad or m
  double rms_truth = 0.0;
  double mean_chi2 = 0.0;  // (error / u)^2
  double largest_u = 0.0;
};

Deviation Compare(const test::TwinRun& run, const Separation& s, Table table, Component c) {
  const bool target = table == Table::kTarget;
  const auto& estimate = target ? s.target : s.reference;
  const TableErrors truth =
      separate::RemoveNotSeparable(target ? run.truth.target : run.truth.reference, table, s.not_separable);
  Deviation d;
  const double n = static_cast<double>(truth[c].size());
  for (std::size_t k = 0; k < truth[c].size(); ++k) {
    const double error = estimate.value[c][k] - truth[c][k];
    d.rms_error += error * error / n;
    d.rms_truth += truth[c][k] * truth[c][k] / n;
    d.mean_chi2 += std::pow(error / estimate.u[c][k], 2) / n;
    d.largest_u = std::max(d.largest_u, estimate.u[c][k]);
  }
  d.rms_error = std::sqrt(d.rms_error);
  d.rms_truth = std::sqrt(d.rms_truth);
  return d;
}

/// Bodies are asked for where the newcomer's run is tested; the others are about estimators.
const std::vector<std::string> kStiff = {"mechanics.fidelity=kinematic"};

void ExpectWithinUncertainty(const test::TwinRun& run, const Separation& s) {
  for (const Table table : {Table::kTarget, Table::kReference}) {
    for (const Component c : (table == Table::kTarget ? s.target : s.reference).components) {
      const Deviation d = Compare(run, s, table, c);
      // About 30 values, half of them independent: mean 1, deviation sqrt(2 / 15) = 0.37; three of these.
      EXPECT_GT(d.mean_chi2, 0.2) << separate::TableName(table) << " " << static_cast<int>(c);
      EXPECT_LT(d.mean_chi2, 2.1) << separate::TableName(table) << " " << static_cast<int>(c);
    }
  }
}

bool Lists(const Separation& s, Table table, Component component, int order) {
  return std::any_of(s.not_separable.begin(), s.not_separable.end(), [&](const separate::NotSeparable& lost) {
    const auto& c = lost.components;
    const bool names = lost.table == table && std::find(c.begin(), c.end(), component) != c.end();
    return names && (lost.all || std::find(lost.orders.begin(), lost.orders.end(), order) != lost.orders.end());
  });
}

TEST(Rotary4Dof, ReturnsEverySeparableErrorWithinItsStatedUncertainty) {
  const test::TwinRun run = test::RunTwin(LoadScenario(test::ScenarioPath("rotary_4dof.toml")));
  const Separation s = test::Evaluate(run);
  ExpectWithinUncertainty(run, s);
  EXPECT_LT(Compare(run, s, Table::kTarget, Component::kEz).largest_u, 0.06 * units::arcsec);
  EXPECT_LT(Compare(run, s, Table::kTarget, Component::kEx).largest_u, 0.08 * units::arcsec);
  EXPECT_LT(Compare(run, s, Table::kTarget, Component::kEy).largest_u, 0.30 * units::arcsec);
  EXPECT_LT(Compare(run, s, Table::kTarget, Component::kDy).largest_u, 0.18 * units::um);
  EXPECT_TRUE(Lists(s, Table::kTarget, Component::kEx, 1));
  EXPECT_TRUE(Lists(s, Table::kReference, Component::kDx, 0));
}

TEST(FourShiftsReclamp, ReadsBothRadialErrorsOfTheReferenceAndKeepsTheRetrogradeWobble) {
  const test::TwinRun run = test::RunTwin(LoadScenario(test::ScenarioPath("four_shifts_reclamp.toml"), kStiff));
  const Separation s = test::Evaluate(run);
  ExpectWithinUncertainty(run, s);
  EXPECT_EQ(s.reference.components.size(), 5u);
  EXPECT_TRUE(Lists(s, Table::kTarget, Component::kEx, 1));
  EXPECT_FALSE(Lists(s, Table::kTarget, Component::kEx, -1));
}

TEST(PaperTwoShifts, GivesTheIndexErrorRightAndTheWobbleWrong) {
  const test::TwinRun run = test::RunTwin(LoadScenario(test::ScenarioPath("paper_two_shifts.toml"), kStiff));
  const Separation published = test::Evaluate(run, Estimator::kPublished);
  const Deviation ez = Compare(run, published, Table::kTarget, Component::kEz);
  const Deviation ex = Compare(run, published, Table::kTarget, Component::kEx);
  EXPECT_LT(ez.rms_error, 0.1 * ez.rms_truth);
  EXPECT_GT(ex.rms_error, 0.5 * ex.rms_truth);
  const Separation rigorous = test::Evaluate(run);
  EXPECT_LT(Compare(run, rigorous, Table::kTarget, Component::kEx).rms_error, 0.1 * ex.rms_truth);
  EXPECT_LE(rigorous.dof, 2) << "8n data for 8n unknowns: no residual can show anything";
}

measure::Stability StabilityOf(const test::BenchRun& run) {
  const auto geometry = measure::NominalGeometry(run.scenario);
  const auto calibration = measure::Calibrate(run.readings, geometry);
  return measure::SummariseStability(measure::Measure(run.readings, geometry, calibration, Estimator::kRigorous),
                                     geometry);
}

TEST(Stability, StaysUnderThePapersFiguresOnlyInASteadyRoom) {
  Scenario scenario = test::AsShipped("stability.toml").scenario;
  const measure::Stability steady = StabilityOf(test::AsShipped("stability.toml"));
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(steady.range[axis], 2.0 * units::arcsec);
  EXPECT_LT(steady.range[3], 1.2 * units::um);
  // 1.2 um is 6 pm: l1 rho / (cos theta sin theta) = 0.2005 um/pm.
  EXPECT_NEAR(1.2 * units::um / std::abs(measure::DisplacementPerWavelength(measure::NominalGeometry(scenario))),
              5.99 * units::pm, 0.01 * units::pm);
  scenario.environment.swing_K *= 10.0;
  const measure::Stability restless = StabilityOf(test::RunBench(scenario));
  EXPECT_GT(restless.range[3], 5.0 * units::um);
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(restless.range[axis], 2.0 * units::arcsec);
}

TEST(Stability, OfPhysicalCausesIsUnderThePapersFiguresAndTheGratingHelps) {
  Scenario scenario = test::AsShipped("stability_hour.toml").scenario;
  const measure::Stability as_it_is = StabilityOf(test::AsShipped("stability_hour.toml"));
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(as_it_is.range[axis], 1.0 * units::arcsec);
  EXPECT_LT(as_it_is.range[3], 1.0 * units::um);
  RotaryOf(scenario).grating.expansion_per_K = 0.0;
  EXPECT_GT(StabilityOf(test::RunBench(scenario)).deviation[3], 1.4 * as_it_is.deviation[3]);
}

TEST(EncoderComparison, ShowsNothingButTheNoiseOfItsDevice) {
  Scenario scenario = LoadScenario(test::ScenarioPath("encoder_comparison.toml"));
  for (const char* kind : {"stops", "sweep"}) {
    EncoderOf(scenario).encoder_procedure.kind = kind;
    const auto comparison = measure::CompareAngles(test::RunEncoderTwin(scenario).readings);
    // 576 readings and more: the deviation is known to 1 / sqrt(2 * 576) = 3 %; three of these.
    EXPECT_NEAR(comparison.rms_rad / EncoderOf(scenario).device.noise_rad, 1.0, 0.09) << kind;
    // Each mean of at least 288 readings has u = noise / sqrt(288); three of these.
    EXPECT_NEAR(comparison.mean_forward_rad, 0.0, 3.0 * EncoderOf(scenario).device.noise_rad / std::sqrt(288.0))
        << kind;
  }
}

TEST(OneOfEverything, SaysThatItsResidualsExceedTheStatedNoise) {
  const test::TwinRun run = test::RunTwin(LoadScenario(test::ScenarioPath("one_of_everything.toml")));
  const Separation s = test::Evaluate(run);
  EXPECT_GT(s.scale.maxCoeff(), 1.5);
  EXPECT_FALSE(s.notes.empty());
  EXPECT_LT(Compare(run, s, Table::kReference, Component::kEz).rms_error, 1.0 * units::arcsec);
}

}  // namespace
}  // namespace twinbench
