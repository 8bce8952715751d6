#include "twin/benches/rotary_4dof/twin/twin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "optics/irradiance.h"
#include "tests/sim/quiet_scenario.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/errors.h"

namespace twinbench::sim {
namespace {

std::array<double, kChannels> ReadOnce(Twin& twin) {
  RotaryBench bench = twin.Bench();
  const Acquisition block = bench.adc.Acquire(10, false);
  EXPECT_EQ(block.status, ReadingStatus::kOk);
  return {block.channel[0].mean_V, block.channel[1].mean_V, block.channel[2].mean_V, block.channel[3].mean_V};
}

TEST(Twin, TheNominalBenchSeesBothSpotsInTheirCentres) {
  Twin twin(Quiet());
  for (const double voltage_V : ReadOnce(twin)) EXPECT_NEAR(voltage_V, 0.0, 1e-9);
}

TEST(Twin, AYawMovesBothSpotsByTheVectorGratingsSensitivity) {
  const Scenario scenario = Quiet();
  Twin twin(scenario);
  const double yaw_rad = 10.0 * units::arcsec;
  twin.Bench().goniometer.MoveTo(yaw_rad, 0.0);
  const auto voltage_V = ReadOnce(twin);
  // l1 (1 + 1 / cos theta) per radian, not the 2 l1 cos theta of the paper; second order in yaw: 1e-5 of it.
  const double cos_theta = std::sqrt(1.0 - 0.39 * 0.39);
  const double expected_V = -yaw_rad * 0.12 * (1.0 + 1.0 / cos_theta) * RotaryOf(scenario).psd_a.sensitivity_V_m;
  EXPECT_NEAR(voltage_V[0] / expected_V, 1.0, 1e-4);
  EXPECT_NEAR(voltage_V[2] / expected_V, 1.0, 1e-4);
}

TEST(Twin, TheAutocollimatorSeesTheGoniometer) {
  Twin twin(Quiet());
  twin.Bench().goniometer.MoveTo(200.0 * units::arcsec, -100.0 * units::arcsec);
  const AutocollimatorReading reading = twin.Bench().autocollimator.Read();
  // Rz(yaw) Rx(tilt): both angles exact, to rounding.
  EXPECT_NEAR(reading.yaw_rad / units::arcsec, 200.0, 1e-6);
  EXPECT_NEAR(reading.tilt_rad / units::arcsec, -100.0, 1e-6);
}

TEST(Twin, TheAutocollimatorShowsNothingOutsideItsRange) {
  Twin twin(Quiet());
  twin.Bench().goniometer.MoveTo(500.0 * units::arcsec, 0.0);
  EXPECT_TRUE(std::isnan(twin.Bench().autocollimator.Read().yaw_rad));
}

TEST(Twin, ASpotBesideThePsdIsAReadingWithoutANumber) {
  Twin twin(Quiet());
  twin.Bench().goniometer.MoveTo(2.0 * units::deg, 0.0);  // 9 mm on a PSD that reaches 5 mm
  const Acquisition block = twin.Bench().adc.Acquire(10, false);
  EXPECT_EQ(block.status, ReadingStatus::kNoLight);
  EXPECT_TRUE(std::isnan(block.channel[0].mean_V));
}

TEST(Twin, AnAmplifierBeyondTheRangeOfTheConverterIsSaturated) {
  Scenario scenario = Quiet();
  scenario.noise_free = false;
  RotaryOf(scenario).amplifier.offset_V[2] = 10.5;
  Twin twin(scenario);
  EXPECT_EQ(twin.Bench().adc.Acquire(10, false).status, ReadingStatus::kSaturated);
}

TEST(Twin, AFifoThatIsNotDrainedOverruns) {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).adc.fifo_samples = 1024;
  RotaryOf(scenario).adc.drain_rate_Hz = 100e3;
  Twin twin(scenario);
  // The FIFO fills at 250 - 100 = 150 kS/s: full after 1024 / 150e3 = 6.8 ms = 427 scans.
  EXPECT_EQ(twin.Bench().adc.Acquire(400, false).status, ReadingStatus::kOk);
  EXPECT_EQ(twin.Bench().adc.Acquire(500, false).status, ReadingStatus::kOverrun);
}

TEST(Twin, MovesTakeTheirTimeOnTheVirtualClock) {
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

TEST(Twin, ABlockTakesTheTimeOfItsConversions) {
  Twin twin(Quiet());
  RotaryBench bench = twin.Bench();
  bench.adc.Acquire(1000, false);
  EXPECT_EQ(bench.clock.Now(), Time{} + std::chrono::milliseconds(16));  // 4000 conversions at 250 kS/s
}

TEST(Twin, SeatingScattersEveryMountingButNotTheStops) {
  Scenario scenario = Quiet();
  scenario.noise_free = false;
  RotaryOf(scenario).amplifier.noise_V = 0.0;
  RotaryOf(scenario).reference.seating_sd[2] = 10.0 * units::arcsec;
  Twin twin(scenario);
  twin.Bench().fixture.Mount(0, 0.0, 0.0);
  const auto first = ReadOnce(twin), again = ReadOnce(twin);
  twin.Bench().fixture.Mount(0, 0.0, 0.0);
  const auto second = ReadOnce(twin);
  for (std::size_t c = 0; c < kChannels; ++c) EXPECT_NEAR(first[c], again[c], 3e-4);  // the light's own noise
  EXPECT_GT(std::abs(first[0] - second[0]), 1e-3);
}

TEST(Twin, RepeatabilityScattersEveryStop) {
  Scenario scenario = Quiet();
  scenario.noise_free = false;
  RotaryOf(scenario).amplifier.noise_V = 0.0;
  RotaryOf(scenario).target.repeatability_sd[2] = 1.0 * units::arcsec;
  Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  const auto visit = [&] {
    bench.target.StartMove(units::deg);
    bench.target.WaitSettled();
    bench.target.StartMove(0.0);
    bench.target.WaitSettled();
    return ReadOnce(twin)[0];
  };
  // 1 arcsec of yaw is 1.2 um or 2.4 mV; two visits differ by that order, and never by nothing.
  const double difference_V = std::abs(visit() - visit());
  EXPECT_GT(difference_V, 1e-5);
  EXPECT_LT(difference_V, 20e-3);
}

TEST(Twin, TheLaserFollowsTheTemperature) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).laser.wavelength_per_kelvin_m = 0.25 * units::nm;
  scenario.environment.temperature_degC = 21.0;
  Twin twin(scenario);
  const auto voltage_V = ReadOnce(twin);
  // l1 rho d lambda / cos theta, apart on both PSDs: 19.5 um at 0.25 nm; second order 2e-4 of it.
  const double shift_V =
      0.12 * 600e3 * 0.25e-9 / std::sqrt(1.0 - 0.39 * 0.39) * RotaryOf(scenario).psd_a.sensitivity_V_m;
  EXPECT_NEAR(voltage_V[0] / shift_V, 1.0, 1e-3);
  EXPECT_NEAR(voltage_V[2] / -shift_V, 1.0, 1e-3);
}

TEST(Twin, AllFidelitiesAgreeOnceTheTablesRest) {
  std::array<std::array<double, kChannels>, 3> at_rest;
  const std::array<const char*, 3> fidelities = {"kinematic", "linear", "bullet"};
  for (std::size_t f = 0; f < 3; ++f) {
    Scenario scenario = Quiet();
    RotaryOf(scenario).mechanics.fidelity = fidelities[f];
    RotaryOf(scenario).mechanics.payload_mass_kg = 1.5;
    RotaryOf(scenario).mechanics.payload_radius_m = 0.040;
    RotaryOf(scenario).mechanics.payload_azimuth_rad =
        0.5 * units::kPi;  // a tilt about x, which both PSDs read well
    Twin twin(scenario);
    RotaryBench bench = twin.Bench();
    bench.target.StartMove(10.0 * units::deg);
    bench.reference.StartMove(-10.0 * units::deg);
    bench.target.WaitSettled();
    bench.reference.WaitSettled();
    bench.clock.Wait(std::chrono::seconds(2));
    at_rest[f] = ReadOnce(twin);
  }
  // In-position is 0.01 arcsec or 12 nm on the PSD, 0.024 mV; the payload's tilt is a hundred times that.
  for (int c = 0; c < kChannels; ++c) {
    EXPECT_NEAR(at_rest[0][c], at_rest[1][c], 1e-4);
    EXPECT_NEAR(at_rest[0][c], at_rest[2][c], 1e-4);
  }
  EXPECT_GT(std::abs(at_rest[0][1]) + std::abs(at_rest[0][0]), 1e-3);
}

TEST(Twin, WritesAPictureOfBothPsds) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).laser.beam = "gaussian";
  Twin twin(scenario);
  const std::string path = ::testing::TempDir() + "irradiance.exr";
  twin.WriteIrradiance(path);
  const auto maps = optics::ReadIrradianceMaps(path);
  ASSERT_EQ(maps.size(), 2u);
  EXPECT_NEAR(optics::Centroid(maps[0]).u_m, 0.0, 20e-9);  // a 2.4 nm shift by divergence, float pixels of 20 um
}

std::string WriteEfficiencies(const std::string& rows) {
  const std::string path = ::testing::TempDir() + "efficiency.csv";
  std::ofstream(path) << "sin_incidence,m-2,m-1,m0,m+1,m+2\n" << rows;
  return path;
}

TEST(Twin, AnEfficiencyTableSharesThePowerOutByIncidence) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).laser.beam = "gaussian";
  RotaryOf(scenario).grating.efficiency_file =
      WriteEfficiencies("-0.01,0.1,0.2,0.2,0.4,0.1\n0.01,0.1,0.4,0.2,0.2,0.1\n");
  Twin twin(scenario);
  const std::string path = ::testing::TempDir() + "shared.exr";
  twin.WriteIrradiance(path);
  const auto maps = optics::ReadIrradianceMaps(path);
  // Half way between the rows both orders carry 0.3 of 5 mW; the picture's pixels lose 1e-4 of a spot at most.
  EXPECT_NEAR(optics::Centroid(maps[0]).power_W, 1.5e-3, 1e-6);
  EXPECT_NEAR(optics::Centroid(maps[1]).power_W, 1.5e-3, 1e-6);
}

TEST(Twin, NamesTheLineOfABadEfficiencyTable) {
  const auto error_of = [](const std::string& rows) -> std::string {
    Scenario scenario = Quiet();
    RotaryOf(scenario).grating.efficiency_file = WriteEfficiencies(rows);
    try {
      Twin twin(scenario);
      return "accepted";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_NE(error_of("0,0.1,0.3,0.1,0.3,0.1\n0,0.1,0.3,0.1,0.3,0.1\n").find("efficiency.csv:3"), std::string::npos);
  EXPECT_NE(error_of("0,0.5,0.5,0.1,0.3,0.1\n").find("efficiency.csv:2: the orders carry more"), std::string::npos);
  EXPECT_NE(error_of("0,-0.1,0.3,0.1,0.3,0.1\n").find("m-2 is negative"), std::string::npos);
  EXPECT_NE(error_of("").find("holds no rows"), std::string::npos);
}

TEST(Twin, AProfileThatIsNotThereIsAnInputError) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).laser.beam = "profile";
  RotaryOf(scenario).laser.profile_file = "/nowhere/beam.exr";
  EXPECT_THROW(Twin twin(scenario), InputError);
}

}  // namespace
}  // namespace twinbench::sim
