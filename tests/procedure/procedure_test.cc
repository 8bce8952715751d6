#include "twin/benches/rotary_4dof/procedure/procedure.h"

#include "tests/fuzz/plain_bench.h"
#include "tests/procedure/troubled_run.h"

namespace twinbench::procedure {
namespace {

using ::testing::ElementsAre;
using test::MemoryLog;

constexpr double kDegree = units::deg;

/// No physics, so that nothing but the procedure is tested. Its autocollimator shows where the goniometer is.
class PlainBench : public fuzz::PlainRotary {
  void MoveTo(double yaw_rad, double tilt_rad) override { shown_ = {yaw_rad, tilt_rad}; }
  AutocollimatorReading Read() override { return shown_; }
  AutocollimatorReading shown_{};
};

MemoryLog CarriedOut(const Scenario& scenario) {
  PlainBench plain;
  MemoryLog log;
  EXPECT_EQ(EndOn(plain.Bench(), scenario, log), "none");
  return log;
}

Scenario With(const std::vector<std::string>& phases) {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).procedure.phases = phases;
  return scenario;
}

Scenario FullCircleOnly(int positions, const std::string& shifts, const std::string& passes) {
  return Altered(With({"full_circle"}), {fmt::format("procedure.positions={}", positions),
                                         "procedure.shifts=" + shifts, "procedure.passes=" + passes});
}

TEST(FullCircle, CountsTurnsOnInsteadOfRewindingBetweenPassesOfTheSameDirection) {
  std::vector<double> angles_deg;
  std::vector<int> positions;
  for (const Reading& r : CarriedOut(FullCircleOnly(4, "[0]", "[1, -1, -1, 1]")).readings) {
    angles_deg.push_back(std::round(r.target_rad / kDegree));
    positions.push_back(r.position);
  }
  EXPECT_THAT(angles_deg, ElementsAre(0, 90, 180, 270, 270, 180, 90, 0, -90, -180, -270, -360, -360, -270, -180, -90));
  EXPECT_THAT(positions, ElementsAre(0, 1, 2, 3, 3, 2, 1, 0, 3, 2, 1, 0, 0, 1, 2, 3));
}

TEST(FullCircle, ApproachesEveryStopInTheDirectionOfItsPass) {
  std::vector<double> moves_rad;
  for (const DeviceCall& call : CarriedOut(FullCircleOnly(4, "[0]", "[1, -1]")).calls)
    if (call.device == "target" && call.request.starts_with("move "))
      moves_rad.push_back(std::stod(call.request.substr(5)));
  // Mounting, run-up, 4 stops, run-up, 4 stops.
  ASSERT_EQ(moves_rad.size(), 11u);
  for (std::size_t k = 2; k < 6; ++k) EXPECT_GT(moves_rad[k], moves_rad[k - 1]);
  for (std::size_t k = 7; k < 11; ++k) EXPECT_LT(moves_rad[k], moves_rad[k - 1]);
}

TEST(Calibration, SweepsYawThenTiltThereAndBack) {
  Scenario scenario = With({"calibration"});
  RotaryOf(scenario).procedure.sweep_points = 3;
  std::vector<double> yaw_arcsec, tilt_arcsec;
  for (const Reading& r : CarriedOut(scenario).readings) {
    yaw_arcsec.push_back(std::round(r.autocollimator_yaw_rad / units::arcsec));
    tilt_arcsec.push_back(std::round(r.autocollimator_tilt_rad / units::arcsec));
  }
  EXPECT_THAT(yaw_arcsec, ElementsAre(-300, 0, 300, 300, 0, -300, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(tilt_arcsec, ElementsAre(0, 0, 0, 0, 0, 0, -300, 0, 300, 300, 0, -300));
}

TEST(Verification, UsesAnglesTheCalibrationDidNotUse) {
  std::vector<double> used;
  for (const Reading& r : CarriedOut(With({"calibration", "verification"})).readings) {
    if (r.phase == Phase::kCalibration) used.push_back(r.autocollimator_yaw_rad);
    if (r.phase != Phase::kVerification || std::abs(r.autocollimator_yaw_rad) < 1e-12) continue;
    for (const double angle_rad : used) EXPECT_GT(std::abs(angle_rad - r.autocollimator_yaw_rad), 1e-6);
  }
}

TEST(Stability, ReadsTheRestingBenchAtItsInterval) {
  const Scenario scenario = Altered(With({"stability"}), {"procedure.stability_s=60", "procedure.stability_interval_s=10"});
  const auto readings = CarriedOut(scenario).readings;
  ASSERT_EQ(readings.size(), 6u);
  EXPECT_NEAR(ToSeconds(readings[5].time - readings[4].time), 10.0, 0.002) << "a block takes 1.6 ms";
}

TEST(CarryOut, TheSeedFixesTheDwellTimes) {
  Scenario scenario = FullCircleOnly(36, "[0]", "[1]");
  RotaryOf(scenario).procedure.dwell_s = {1.0, 2.0, 4.0};
  const auto dwell_times = [&](std::uint64_t seed) {
    scenario.seed = seed;
    std::vector<double> dwell_s;
    for (const Reading& r : CarriedOut(scenario).readings) dwell_s.push_back(r.dwell_s);
    return dwell_s;
  };
  EXPECT_EQ(dwell_times(3), dwell_times(3));
  EXPECT_NE(dwell_times(3), dwell_times(4));
}

TEST(CarryOut, AsksForRawBlocksOnlyWhereTheyAreKept) {
  Scenario scenario = FullCircleOnly(4, "[0]", "[1]");
  const auto raw_blocks = [&] {
    return std::ranges::count_if(CarriedOut(scenario).calls, [](const DeviceCall& call) {
      return call.request.starts_with("acquire ") && call.request.ends_with(" raw");
    });
  };
  EXPECT_EQ(raw_blocks(), 0);
  RotaryOf(scenario).procedure.keep_raw = true;
  EXPECT_EQ(raw_blocks(), 4);
}

}  // namespace
}  // namespace twinbench::procedure
