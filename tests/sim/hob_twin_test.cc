#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "tests/support/angle_benches.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/hob_transmission/twin/world.h"
#include "twin/benches/names.h"
#include "twin/core/device_fault.h"
#include "twin/core/effect_catalogue.h"

namespace twinbench {
namespace {

using units::arcsec;
using units::deg;

/// A machine without errors and noise: one head, one turn each way, 180 samples a turn.
Scenario QuietMachine() {
  Scenario s;
  s.bench = kHobBench;
  s.noise_free = true;
  HobOf(s).hob_procedure.heads_rad = {0.0};
  HobOf(s).hob_procedure.turns = 1;
  HobOf(s).hob_procedure.samples_per_turn = 180;
  HobOf(s).hob_encoder.lines = 8192;  // a whole number of lines between samples would hide what repeats with them
  return s;
}

std::vector<Reading> HobReadings(const Scenario& scenario) {
  return test::RunHob(scenario).readings;
}

/// table - ratio x hob, its mean over the readings taken out.
std::vector<double> Differences_arcsec(const std::vector<Reading>& readings, double ratio) {
  std::vector<double> m;
  double mean = 0.0;
  for (const Reading& r : readings) {
    m.push_back((r.measured_rad - ratio * r.reference_rad) / arcsec);
    mean += m.back() / static_cast<double>(readings.size());
  }
  for (double& value : m) value -= mean;
  return m;
}

TEST(HobTwin, KeepsOneSampleAtEveryHundredthLineOfTheTablesEncoder) {
  const auto readings = HobReadings(QuietMachine());
  ASSERT_EQ(readings.size(), 360u);
  for (std::size_t i = 1; i < 180; ++i)
    EXPECT_NEAR(readings[i].measured_rad - readings[i - 1].measured_rad, 2.0 * deg, 1e-12);
  for (std::size_t i = 181; i < 360; ++i)
    EXPECT_NEAR(readings[i].measured_rad - readings[i - 1].measured_rad, -2.0 * deg, 1e-12);
  EXPECT_EQ(readings[0].direction, 1);
  EXPECT_EQ(readings[200].direction, -1);
}

TEST(HobTwin, EveryDeviceSchedulesEvents) {
  sim::HobWorld world(QuietMachine());
  world.Mount(10.0 * deg);
  world.Arm(100, 20);
  world.Run(10.0 * deg, std::chrono::seconds(1));
  world.RunUntil(world.Now() + std::chrono::seconds(3));
  for (const char* device : {"fixture", "counters", "drive"}) EXPECT_GT(world.Scheduled().at(device), 0U) << device;
}

TEST(HobTwin, WithoutErrorsBothEncodersKeepTheRatio) {
  const Scenario s = QuietMachine();
  for (const double m_arcsec : Differences_arcsec(HobReadings(s), HobOf(s).transmission.Ratio()))
    EXPECT_NEAR(m_arcsec, 0.0, 1e-6);
}

TEST(HobTwin, ShowsTheTransmissionErrorByTheTablesAngle) {
  Scenario s = QuietMachine();
  HobOf(s).hob_procedure.passes = {1};
  HobOf(s).transmission.harmonics = {{Component::kEz, 3.0, 7.0 * arcsec, 0.5}};
  const auto readings = HobReadings(s);
  const auto m_arcsec = Differences_arcsec(readings, HobOf(s).transmission.Ratio());
  for (std::size_t i = 0; i < m_arcsec.size(); ++i)
    EXPECT_NEAR(m_arcsec[i], 7.0 * std::cos(3.0 * readings[i].measured_rad + 0.5), 1e-3);
}

TEST(HobTwin, InterferometerSeesTheMachineAndNotTheEncoder) {
  Scenario s = QuietMachine();
  HobOf(s).transmission.harmonics = {{Component::kEz, 3.0, 7.0 * arcsec, 0.5}};
  HobOf(s).table_encoder.eccentricity_m = 3e-6;
  for (const Reading& r : HobReadings(s))
    EXPECT_NEAR(r.interferometer_rad / arcsec, 7.0 * std::cos(3.0 * r.measured_rad + 0.5), 1e-2)
        << "the encoder's 6 arcsec move the angle, 3 x 7 arcsec x 3e-5";
}

TEST(HobTwin, InterferometerHasErrorsOfItsOwn) {
  Scenario s = QuietMachine();
  HobOf(s).transmission.harmonics = {{Component::kEz, 3.0, 7.0 * arcsec, 0.5}};
  const auto clean = HobReadings(s);
  InterferometerSettings& i = HobOf(s).interferometer;
  const InterferometerSettings ideal = i;
  const auto shown = [&](std::size_t k) { return HobReadings(s).at(k).interferometer_rad; };
  constexpr std::size_t kLate = 300;
  const double deviation_rad = clean.at(kLate).interferometer_rad;
  ASSERT_GT(std::abs(deviation_rad), 1.0 * arcsec);

  i.misalignment_rad = 0.1;  // it sees the way along its beam
  EXPECT_NEAR(shown(kLate), deviation_rad * std::cos(0.1), 1e-12);
  i = ideal;
  i.arm_error_m = 0.01 * i.arm_m;  // a longer arm moves its reflector more
  EXPECT_NEAR(shown(kLate), deviation_rad * 1.01, 1e-12);
  i = ideal;
  i.calibrator = {{Component::kEz, 2.0, 1.5 * arcsec, 0.7}};
  EXPECT_NEAR(shown(kLate), deviation_rad + 1.5 * arcsec * std::cos(2.0 * clean.at(kLate).measured_rad + 0.7),
              1e-3 * arcsec)
      << "the table is off its encoder's angle by arcseconds";
  i = ideal;
  i.dead_path_m = 0.3;  // in air that changes by 6 ppm an hour
  i.index_drift_per_h = 6e-6;
  const double hours = ToSeconds(clean.at(kLate).time) / 3600.0;
  EXPECT_NEAR(shown(kLate), deviation_rad * (1.0 + 6e-6 * hours) + 0.3 / i.arm_m * 6e-6 * hours, 1e-12);
}

TEST(HobTwin, InterferometerSeesWhatTheTableDoesAndNotWhatItsCountersGetWrong) {
  const Scenario s = QuietMachine();
  const auto clean = HobReadings(s);
  const auto seen_arcsec = [&](const EffectSettings& effect) {
    Scenario with = s;
    with.effects = {effect};
    return (HobReadings(with).at(100).interferometer_rad - clean.at(100).interferometer_rad) / arcsec;
  };
  EXPECT_NEAR(seen_arcsec({"hysteresis", "", {{"lag", 5.0 * arcsec}, {"settles_over", 5.0 * deg}}, ""}), -5.0,
              1e-6);
  EXPECT_NEAR(seen_arcsec({"latency", "", {{"delay", 1e-3}}, ""}), 0.0, 1e-9);
  EXPECT_NEAR(seen_arcsec({"slip", "table", {{"step", 72.0 * arcsec}, {"at_reading", 5.0}}, ""}), 0.0, 1e-9);
}

/// Order 1 of what one head sees.
std::complex<double> OrderOne_arcsec(const Scenario& s) {
  const auto readings = HobReadings(s);
  const auto m_arcsec = Differences_arcsec(readings, HobOf(s).transmission.Ratio());
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < readings.size(); ++i)
    sum += m_arcsec[i] * std::polar(2.0 / static_cast<double>(readings.size()), -readings[i].measured_rad);
  return sum;
}

TEST(HobTwin, EncodersErrorMovesWithItsHead) {
  Scenario s = QuietMachine();
  HobOf(s).table_encoder.eccentricity_m = 2.0e-6;
  HobOf(s).table_encoder.eccentricity_azimuth_rad = 70.0 * deg;
  const double amplitude_arcsec = 2.0e-6 / HobOf(s).table_encoder.radius_m / arcsec;
  const std::complex<double> at_zero = OrderOne_arcsec(s);
  EXPECT_NEAR(std::abs(at_zero), amplitude_arcsec, 1e-3);
  HobOf(s).hob_procedure.heads_rad = {50.0 * deg};
  const std::complex<double> at_50 = OrderOne_arcsec(s);
  EXPECT_NEAR(std::abs(at_50 - at_zero * std::polar(1.0, -50.0 * deg)), 0.0, 1e-3) << "psi(th - head)";
}

TEST(HobTwin, CountsFromTheMarkIfToldSo) {
  Scenario s = QuietMachine();
  HobOf(s).hob_procedure.heads_rad = {50.0 * deg};
  const auto from_origin = HobReadings(s);
  HobOf(s).hob_procedure.encoder_zero = "reference_mark";
  const auto from_mark = HobReadings(s);
  EXPECT_NEAR(from_origin[0].measured_rad - from_mark[0].measured_rad, 50.0 * deg, 1e-12);
}

TEST(HobTwin, BulletAgreesWithTheKinematicChainOnSlowErrors) {
  Scenario s = QuietMachine();
  HobOf(s).transmission.harmonics = {{Component::kEz, 2.0, 5.0 * arcsec, 0.0},
                                     {Component::kEz, 22.0, 2.0 * arcsec, 1.0}};
  const auto kinematic = Differences_arcsec(HobReadings(s), HobOf(s).transmission.Ratio());
  HobOf(s).mechanics.fidelity = "bullet";
  const auto bullet = Differences_arcsec(HobReadings(s), HobOf(s).transmission.Ratio());
  // Order 22 is 0.83 Hz against a torsional mode of 80 Hz: (0.83 / 80)^2 = 1e-4 of 2 arcsec.
  for (std::size_t i = 0; i < bullet.size(); ++i) EXPECT_NEAR(bullet[i], kinematic[i], 0.02) << i;
}

TEST(HobTwin, EndsWithAFaultWhenTheFifoRunsFull) {
  Scenario s = QuietMachine();
  HobOf(s).hob_procedure.fifo_samples = 4;
  HobOf(s).hob_procedure.poll_s = 2.0;  // 14 samples come meanwhile
  try {
    HobReadings(s);
    FAIL() << "no fault";
  } catch (const DeviceFault& fault) {
    EXPECT_EQ(fault.kind(), FaultKind::kOverrun);
  }
}

TEST(HobTwin, GivesTheSameBitsForTheSameSeed) {
  Scenario s = QuietMachine();
  s.noise_free = false;
  HobOf(s).table_encoder.noise_rad = 0.3 * arcsec;
  const auto a = HobReadings(s), b = HobReadings(s);
  s.seed = 2;
  const auto other = HobReadings(s);
  int differ = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].measured_rad, b[i].measured_rad);
    EXPECT_EQ(a[i].reference_rad, b[i].reference_rad);
    differ += a[i].measured_rad != other[i].measured_rad;
  }
  EXPECT_GT(differ, 300);
}

TEST(HobTwin, HasEveryEffectOfTheCatalogueAndEachChangesTheReadings) {
  const Scenario s = QuietMachine();
  const auto clean = HobReadings(s);
  for (const EffectEntry& entry : EffectCatalogue(kHobBench)) {
    Scenario with = s;
    with.effects = {test::PlainEffect(entry)};
    const auto disturbed = HobReadings(with);
    double largest_rad = 0.0;
    for (std::size_t i = 0; i < clean.size(); ++i)
      largest_rad = std::max({largest_rad, std::abs(disturbed[i].measured_rad - clean[i].measured_rad),
                              std::abs(disturbed[i].reference_rad - clean[i].reference_rad)});
    EXPECT_GT(largest_rad, 1e-3 * arcsec) << entry.name;
  }
}

}  // namespace
}  // namespace twinbench
