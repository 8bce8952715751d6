#include "twin/benches/rotary_4dof/procedure/procedure.h"

#include <gmock/gmock.h>

#include "tests/support/rotary_scenario.h"

namespace twinbench::procedure {
namespace {

using ::testing::ElementsAre;

constexpr double kDegree = units::deg;

/// A bench that only writes down what it was asked for: no physics, so that nothing but the procedure is tested.
class LogBench : public Clock,
                 public AdConverter,
                 public Autocollimator,
                 public Thermometer,
                 public Goniometer,
                 public Fixture,
                 public ReadingSink {
 public:
  struct Table : RotaryTable {
    void StartMove(double angle_rad) override { moves_deg.push_back(angle_rad / kDegree); }
    bool Settles(Duration) override { return ++settled > 0; }
    TableState State() override {
      TableState state;
      state.commanded_rad = state.encoder_rad = moves_deg.empty() ? 0.0 : moves_deg.back() * kDegree;
      state.in_position = true;
      return state;
    }
    void Stop() override { ++stops; }
    void Home() override {}
    std::vector<double> moves_deg;
    int settled = 0, stops = 0;
  };
  struct Mounting {
    int setup;
    double clamp_deg, reseat_deg;
  };

  Time Now() const override { return now; }
  void Wait(Duration duration) override { now += duration; }
  Acquisition Acquire(int n_samples, bool keep_raw) override {
    Acquisition block;
    block.start = now;
    block.n_samples = n_samples;
    for (ChannelBlock& channel : block.channel) channel = {1.0, 0.1, 0.9, 1.1};
    if (keep_raw) block.raw.assign(static_cast<std::size_t>(n_samples) * kChannels, 7);
    return block;
  }
  AutocollimatorReading Read() override { return {yaw_rad, tilt_rad}; }
  double Read_degC() override { return 20.5; }
  void MoveTo(double yaw, double tilt) override { yaw_rad = yaw, tilt_rad = tilt; }
  void Mount(int setup, double clamp_rad, double reseat_rad) override {
    mountings.push_back({setup, clamp_rad / kDegree, reseat_rad / kDegree});
  }
  void Append(const Reading& reading, const Acquisition& block) override {
    readings.push_back(reading);
    raw_sizes.push_back(block.raw.size());
  }

  RotaryBench Bench() { return {*this, target, reference, *this, *this, *this, *this, *this}; }

  Time now{};
  Table target, reference;
  double yaw_rad = 0.0, tilt_rad = 0.0;
  std::vector<Mounting> mountings;
  std::vector<Reading> readings;
  std::vector<std::size_t> raw_sizes;
};

Scenario With(const std::vector<std::string>& phases) {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).procedure.phases = phases;
  return scenario;
}

Scenario FullCircleOnly(int positions, std::vector<int> shifts, std::vector<int> passes) {
  Scenario scenario = With({"full_circle"});
  RotaryOf(scenario).procedure.positions = positions;
  RotaryOf(scenario).procedure.shifts = std::move(shifts);
  RotaryOf(scenario).procedure.passes = std::move(passes);
  return scenario;
}

std::vector<Reading> CarryOutOn(LogBench& log, const Scenario& scenario) {
  RotaryBench bench = log.Bench();
  CarryOut(bench, scenario, log);
  return log.readings;
}

std::vector<double> TargetAngles_deg(const std::vector<Reading>& readings) {
  std::vector<double> angles;
  for (const Reading& r : readings) angles.push_back(std::round(r.target_rad / kDegree));
  return angles;
}

TEST(FullCircle, CountsTurnsOnInsteadOfRewindingBetweenPassesOfTheSameDirection) {
  LogBench log;
  const auto readings = CarryOutOn(log, FullCircleOnly(4, {0}, {1, -1, -1, 1}));
  EXPECT_THAT(TargetAngles_deg(readings), ElementsAre(0, 90, 180, 270, 270, 180, 90, 0, -90, -180, -270, -360,  //
                                                      -360, -270, -180, -90));
  std::vector<int> positions;
  for (const Reading& r : readings) positions.push_back(r.position);
  EXPECT_THAT(positions, ElementsAre(0, 1, 2, 3, 3, 2, 1, 0, 3, 2, 1, 0, 0, 1, 2, 3));
}

TEST(FullCircle, ApproachesEveryStopInTheDirectionOfItsPass) {
  LogBench log;
  CarryOutOn(log, FullCircleOnly(4, {0}, {1, -1}));
  // Moves: mounting, run-up, 4 stops, run-up, 4 stops.
  ASSERT_EQ(log.target.moves_deg.size(), 11u);
  for (int k = 2; k < 6; ++k) EXPECT_GT(log.target.moves_deg[k], log.target.moves_deg[k - 1]);
  for (int k = 7; k < 11; ++k) EXPECT_LT(log.target.moves_deg[k], log.target.moves_deg[k - 1]);
}

TEST(Calibration, SweepsYawThenTiltThereAndBack) {
  LogBench log;
  Scenario scenario = With({"calibration"});
  RotaryOf(scenario).procedure.sweep_points = 3;
  const auto readings = CarryOutOn(log, scenario);
  std::vector<double> yaw_arcsec, tilt_arcsec;
  for (const Reading& r : readings) {
    yaw_arcsec.push_back(std::round(r.autocollimator_yaw_rad / units::arcsec));
    tilt_arcsec.push_back(std::round(r.autocollimator_tilt_rad / units::arcsec));
  }
  EXPECT_THAT(yaw_arcsec, ElementsAre(-300, 0, 300, 300, 0, -300, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(tilt_arcsec, ElementsAre(0, 0, 0, 0, 0, 0, -300, 0, 300, 300, 0, -300));
}

TEST(Verification, UsesAnglesTheCalibrationDidNotUse) {
  LogBench log;
  Scenario scenario = With({"calibration", "verification"});
  std::vector<double> used;
  for (const Reading& r : CarryOutOn(log, scenario)) {
    if (r.phase == Phase::kCalibration) used.push_back(r.autocollimator_yaw_rad);
    if (r.phase != Phase::kVerification || std::abs(r.autocollimator_yaw_rad) < 1e-12) continue;
    for (const double angle_rad : used) EXPECT_GT(std::abs(angle_rad - r.autocollimator_yaw_rad), 1e-6);
  }
}

TEST(Stability, ReadsTheRestingBenchAtItsInterval) {
  LogBench log;
  Scenario scenario = With({"stability"});
  RotaryOf(scenario).procedure.stability_s = 60.0;
  RotaryOf(scenario).procedure.stability_interval_s = 10.0;
  const auto readings = CarryOutOn(log, scenario);
  ASSERT_EQ(readings.size(), 6u);
  EXPECT_EQ(readings[5].time - readings[4].time, std::chrono::seconds(10));
}

TEST(CarryOut, PlansAsManyReadingsAsItMakes) {
  LogBench log;
  Scenario scenario = With({"calibration", "stability", "verification", "full_circle"});
  EXPECT_EQ(static_cast<int>(CarryOutOn(log, scenario).size()), PlannedReadings(RotaryOf(scenario).procedure));
}

TEST(CarryOut, TheSeedFixesTheDwellTimes) {
  Scenario scenario = FullCircleOnly(36, {0}, {1});
  RotaryOf(scenario).procedure.dwell_s = {1.0, 2.0, 4.0};
  const auto dwell_times = [&](std::uint64_t seed) {
    LogBench log;
    scenario.seed = seed;
    std::vector<double> dwell_s;
    for (const Reading& r : CarryOutOn(log, scenario)) dwell_s.push_back(r.dwell_s);
    return dwell_s;
  };
  EXPECT_EQ(dwell_times(3), dwell_times(3));
  EXPECT_NE(dwell_times(3), dwell_times(4));
}

TEST(CarryOut, KeepsRawBlocksOnlyWhenAsked) {
  Scenario scenario = FullCircleOnly(4, {0}, {1});
  LogBench without, with;
  CarryOutOn(without, scenario);
  RotaryOf(scenario).procedure.keep_raw = true;
  CarryOutOn(with, scenario);
  EXPECT_EQ(without.raw_sizes[0], 0u);
  EXPECT_EQ(with.raw_sizes[0], static_cast<std::size_t>(RotaryOf(scenario).adc.samples) * kChannels);
}

}  // namespace
}  // namespace twinbench::procedure
