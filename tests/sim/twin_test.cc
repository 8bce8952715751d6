#include "twin/benches/rotary_4dof/twin/twin.h"

#include "optics/irradiance.h"
#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"
#include "tests/support/rotary_scenario.h"

namespace twinbench::sim {
namespace {

std::array<double, kChannels> ReadOnce(Twin& twin) {
  RotaryBench bench = twin.Bench();
  const Acquisition block = bench.adc.Acquire(10, false);
  EXPECT_EQ(block.status, ReadingStatus::kOk);
  return {block.channel[0].mean_V, block.channel[1].mean_V, block.channel[2].mean_V, block.channel[3].mean_V};
}

TEST(Twin, MovesAndBlocksTakeTheirTimeOnTheVirtualClock) {
  Scenario scenario = Quiet();
  Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  bench.target.StartMove(10.0 * units::deg);
  bench.target.WaitSettled();
  // 0.6 s profile and 0.4 s in-position window.
  EXPECT_EQ(bench.clock.Now(), Time{} + std::chrono::milliseconds(1000));
  EXPECT_NEAR(bench.target.EncoderAngle_rad(), 10.0 * units::deg, 1e-12);
  bench.target.StartMove(100.0 * units::deg);  // 90 deg at 30 deg/s
  bench.target.WaitSettled();
  EXPECT_EQ(bench.clock.Now(), Time{} + std::chrono::milliseconds(1000 + 3400));
  bench.adc.Acquire(1000, false);
  EXPECT_EQ(bench.clock.Now(), Time{} + std::chrono::milliseconds(1000 + 3400 + 16));  // 4000 at 250 kS/s
}

TEST(Twin, ATableThatHasArrivedSaysSoWhileTheOtherStillMoves) {
  for (const char* fidelity : {"kinematic", "linear", "bullet"}) {
    Scenario scenario = Quiet();
    RotaryOf(scenario).mechanics.fidelity = fidelity;
    RotaryOf(scenario).reference.speed_rad_s = 5.0 * units::deg;
    Twin twin(scenario);
    RotaryBench bench = twin.Bench();
    bench.target.StartMove(30.0 * units::deg);
    bench.reference.StartMove(-30.0 * units::deg);  // for 6 s
    bench.target.WaitSettled();
    EXPECT_EQ(bench.clock.Now(), Time{} + std::chrono::milliseconds(1000 + 400)) << fidelity;
    EXPECT_TRUE(bench.target.State().in_position) << fidelity;
    EXPECT_TRUE(bench.reference.State().moving) << fidelity;
    EXPECT_FALSE(bench.reference.State().in_position) << fidelity;
    bench.reference.WaitSettled();
    EXPECT_EQ(bench.clock.Now(), Time{} + std::chrono::milliseconds(6000 + 400)) << fidelity;
    EXPECT_NO_THROW(bench.fixture.Mount(1, 0.0, 0.0)) << fidelity;
  }
}

TEST(Twin, WhoMountsWaitsForTheServosButNotForAMove) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).mechanics.fidelity = "linear";
  RotaryOf(scenario).target.settle_s = RotaryOf(scenario).reference.settle_s = 0.0;
  Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  bench.target.StartMove(10.0 * units::deg);
  bench.clock.Wait(std::chrono::milliseconds(590));
  EXPECT_THROW(bench.fixture.Mount(1, 0.0, 0.0), BenchError);
  bench.clock.Wait(std::chrono::milliseconds(10));  // the profile is over, the servo is not
  EXPECT_FALSE(bench.target.State().in_position);
  EXPECT_NO_THROW(bench.fixture.Mount(1, 0.0, 0.0));
  EXPECT_TRUE(bench.target.State().in_position);
  EXPECT_LT(bench.clock.Now(), Time{} + std::chrono::milliseconds(600 + 200));  // a 30 Hz servo, some 100 ms
}

TEST(Twin, SeatingScattersEveryMountingAndRepeatabilityEveryStop) {
  Scenario seated = OnlyTheLightsNoise(), stopped = seated;
  RotaryOf(seated).reference.seating_sd[2] = 10.0 * units::arcsec;
  Twin twin(seated);
  twin.Bench().fixture.Mount(0, 0.0, 0.0);
  const auto first = ReadOnce(twin), again = ReadOnce(twin);
  twin.Bench().fixture.Mount(0, 0.0, 0.0);
  for (std::size_t c = 0; c < kChannels; ++c) EXPECT_NEAR(first[c], again[c], 3e-4);  // the light's own noise
  EXPECT_GT(std::abs(first[0] - ReadOnce(twin)[0]), 1e-3);
  RotaryOf(stopped).target.repeatability_sd[2] = 1.0 * units::arcsec;
  Twin repeating(stopped);
  const auto visit = [&, bench = repeating.Bench()] {
    for (const double angle_rad : {units::deg, 0.0}) {
      bench.target.StartMove(angle_rad);
      bench.target.WaitSettled();
    }
    return ReadOnce(repeating)[0];
  };
  // 1 arcsec of yaw is 1.2 um or 2.4 mV; two visits differ by that order, and never by nothing.
  const double difference_V = std::abs(visit() - visit());
  EXPECT_GT(difference_V, 1e-5);
  EXPECT_LT(difference_V, 20e-3);
}

std::string WriteEfficiencies(const TemporaryFolder& folder, const std::string& rows) {
  return folder.Write("efficiency.csv", "sin_incidence,m-2,m-1,m0,m+1,m+2\n" + rows);
}

TEST(Twin, WritesAPictureOfBothPsdsAndAnEfficiencyTableSharesThePowerOutByIncidence) {
  const TemporaryFolder folder;
  Scenario scenario = Quiet();
  RotaryOf(scenario).laser.beam = "gaussian";
  RotaryOf(scenario).grating.efficiency_file =
      WriteEfficiencies(folder, "-0.01,0.1,0.2,0.2,0.4,0.1\n0.01,0.1,0.4,0.2,0.2,0.1\n");
  Twin(scenario).WriteIrradiance(folder.File("irradiance.exr"));
  const auto maps = optics::ReadIrradianceMaps(folder.File("irradiance.exr"));
  ASSERT_EQ(maps.size(), 2u);
  EXPECT_NEAR(optics::Centroid(maps[0]).u_m, 0.0, 20e-9);  // a 2.4 nm shift by divergence, float pixels of 20 um
  // Half way between the rows both orders carry 0.3 of 5 mW; the picture's pixels lose 1e-4 of a spot at most.
  for (const auto& map : maps) EXPECT_NEAR(optics::Centroid(map).power_W, 1.5e-3, 1e-6);
}

TEST(Twin, NamesFileAndLineOfWhatItCannotUse) {
  const TemporaryFolder folder;
  const auto expect_refused = [&](const std::function<void(Scenario&)>& change) {
    Scenario scenario = Quiet();
    change(scenario);
    EXPECT_KEPT(MessageOf([&] { Twin twin(scenario); }));
  };
  for (const char* rows : {"0,0.1,0.3,0.1,0.3,0.1\n0,0.1,0.3,0.1,0.3,0.1\n", "0,0.5,0.5,0.1,0.3,0.1\n",
                           "0,-0.1,0.3,0.1,0.3,0.1\n", ""})
    expect_refused([&](Scenario& s) { RotaryOf(s).grating.efficiency_file = WriteEfficiencies(folder, rows); });
  expect_refused([](Scenario& s) {
    RotaryOf(s).laser.beam = "profile";
    RotaryOf(s).laser.profile_file = "/nowhere/beam.exr";
  });
  expect_refused([](Scenario& s) { RotaryOf(s).grating.ruling_file = "no_such_map.exr"; });
  expect_refused(
      [&](Scenario& s) { RotaryOf(s).adc.inl_file = folder.Write("inl.csv", "voltage_V,error_mV\n1,0\n1,0\n"); });
  expect_refused([&](Scenario& s) {
    s.environment.temperature_file = folder.Write("room.csv", "time_s,temperature_degC\n10,20\nten,21\n");
  });
  expect_refused([](Scenario& s) {
    s.fixtures.resize(1);
    s.fixtures[0].name = "housing";
    s.fixtures[0].mesh_file = "/nowhere/housing.stl";
    s.fixtures[0].location = "bench.toml:7";
  });
}

}  // namespace
}  // namespace twinbench::sim
