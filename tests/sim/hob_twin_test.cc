#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "tests/support/angle_benches.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/hob_transmission/twin/world.h"
#include "twin/benches/names.h"

namespace twinbench {
namespace {

using units::arcsec, units::deg;

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

TEST(HobTwin, KeepsOneSampleAtEveryHundredthLineOfTheTablesEncoderAndTheRatioWithoutErrors) {
  const Scenario s = QuietMachine();
  const auto readings = HobReadings(s);
  ASSERT_EQ(readings.size(), 360u);
  for (std::size_t i = 1; i < 180; ++i)
    EXPECT_NEAR(readings[i].measured_rad - readings[i - 1].measured_rad, 2.0 * deg, 1e-12);
  for (std::size_t i = 181; i < 360; ++i)
    EXPECT_NEAR(readings[i].measured_rad - readings[i - 1].measured_rad, -2.0 * deg, 1e-12);
  EXPECT_EQ(readings[0].direction, 1);
  EXPECT_EQ(readings[200].direction, -1);
  for (const double m_arcsec : Differences_arcsec(readings, HobOf(s).transmission.Ratio()))
    EXPECT_NEAR(m_arcsec, 0.0, 1e-6);
}

TEST(HobTwin, EveryDeviceSchedulesEvents) {
  sim::HobWorld world(QuietMachine());
  world.Mount(10.0 * deg);
  world.Arm(100, 20);
  world.Run(10.0 * deg, std::chrono::seconds(1));
  world.RunUntil(world.Now() + std::chrono::seconds(3));
  for (const char* device : {"fixture", "counters", "drive"}) EXPECT_GT(world.Scheduled().at(device), 0U) << device;
}

TEST(HobTwin, InterferometerSeesTheMachineAndHasErrorsOfItsOwn) {
  Scenario s = QuietMachine();
  HobOf(s).transmission.harmonics = {{Component::kEz, 3.0, 7.0 * arcsec, 0.5}};
  constexpr std::size_t kLate = 300;
  const Reading clean = HobReadings(s).at(kLate);
  const double deviation_rad = clean.interferometer_rad;
  ASSERT_GT(std::abs(deviation_rad), 1.0 * arcsec);
  const double hours = ToSeconds(clean.time) / 3600.0, arm_m = HobOf(s).interferometer.arm_m;
  using Change = void (*)(InterferometerSettings&);
  const std::tuple<Change, double, double> changes[] = {
      {[](auto& i) { i.misalignment_rad = 0.1; }, deviation_rad * std::cos(0.1), 1e-12},  // the way along its beam
      {[](auto& i) { i.arm_error_m = 0.01 * i.arm_m; }, deviation_rad * 1.01, 1e-12},  // a longer arm moves more
      {[](auto& i) { i.calibrator = {{Component::kEz, 2.0, 1.5 * arcsec, 0.7}}; },  // by an angle off by arcseconds
       deviation_rad + 1.5 * arcsec * std::cos(2.0 * clean.measured_rad + 0.7), 1e-3 * arcsec},
      {[](auto& i) { i.dead_path_m = 0.3, i.index_drift_per_h = 6e-6; },  // in air that changes by 6 ppm an hour
       deviation_rad * (1.0 + 6e-6 * hours) + 0.3 / arm_m * 6e-6 * hours, 1e-12}};
  for (const auto& [change, expected_rad, within_rad] : changes) {
    Scenario changed = s;
    change(HobOf(changed).interferometer);
    EXPECT_NEAR(HobReadings(changed).at(kLate).interferometer_rad, expected_rad, within_rad);
  }
  HobOf(s).table_encoder.eccentricity_m = 3e-6;
  for (const Reading& r : HobReadings(s))
    EXPECT_NEAR(r.interferometer_rad / arcsec, 7.0 * std::cos(3.0 * r.measured_rad + 0.5), 1e-2)
        << "the encoder's 6 arcsec move the angle, 3 x 7 arcsec x 3e-5";
}

TEST(HobTwin, InterferometerSeesWhatTheTableDoesAndNotWhatItsCountersGetWrong) {
  const Scenario s = QuietMachine();
  const double clean_rad = HobReadings(s).at(100).interferometer_rad;
  const std::pair<EffectSettings, double> effects[] = {
      {{"hysteresis", "", {{"lag", 5.0 * arcsec}, {"settles_over", 5.0 * deg}}, ""}, -5.0},
      {{"latency", "", {{"delay", 1e-3}}, ""}, 0.0},
      {{"slip", "table", {{"step", 72.0 * arcsec}, {"at_reading", 5.0}}, ""}, 0.0}};
  for (const auto& [effect, seen_arcsec] : effects) {
    Scenario with = s;
    with.effects = {effect};
    const double shown_rad = HobReadings(with).at(100).interferometer_rad - clean_rad;
    EXPECT_NEAR(shown_rad / arcsec, seen_arcsec, seen_arcsec == 0.0 ? 1e-9 : 1e-6) << effect.name;
  }
}

TEST(HobTwin, CountsFromTheMarkIfToldSo) {
  Scenario s = QuietMachine();
  HobOf(s).hob_procedure.heads_rad = {50.0 * deg};
  const auto from_origin = HobReadings(s);
  HobOf(s).hob_procedure.encoder_zero = "reference_mark";
  const auto from_mark = HobReadings(s);
  EXPECT_NEAR(from_origin[0].measured_rad - from_mark[0].measured_rad, 50.0 * deg, 1e-12);
}

}  // namespace
}  // namespace twinbench
