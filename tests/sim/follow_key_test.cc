#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/core/input_error.h"
#include "tests/support/angle_benches.h"
#include "tests/support/small_scenario.h"
#include "tests/support/twin_run.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/encoder_comparison/twin/follow.h"
#include "twin/benches/rotary_4dof/twin/follow.h"

// A small bench without noise before and after a change of a key: the twin which follows the records shows the same
// difference.
namespace twinbench::sim {
namespace {

constexpr int kBlockScans = 1000;  // 16 ms
constexpr double kConversion_s = 4e-6, kTone_V = 2e-3;

struct FollowedKey {
  std::string name;
  std::function<void(Scenario&)> prepare;
  std::function<void(RotarySettings&)> change;
  double within_V, at_least_V;  // of each reading's difference; of what the change does to some reading
};

void AddTone(Scenario& s, double frequency_Hz, const std::string& signal = "") {
  s.effects = {{signal.empty() ? "tone" : "signal", signal.empty() ? "all" : signal,
                {{"amplitude", 1e-6}, {"frequency", frequency_Hz}, {"phase", 0.4}}, "test"}};
  if (!signal.empty()) s.effects[0].signal = "tone";
  RotaryOf(s).adc.samples = kBlockScans;
}

FollowedKey PassedTone(double frequency_Hz, double corner_Hz) {
  // Channels are converted up to 12 us one after the other, of which the twin that follows knows nothing.
  const double x = units::kPi * frequency_Hz * kBlockScans * 4.0 * kConversion_s;
  const double open_V = kTone_V * std::abs(std::sin(x) / x);
  return {fmt::format("a low-pass of {} Hz behind a tone of {} Hz", corner_Hz, frequency_Hz),
          [=](Scenario& s) { AddTone(s, frequency_Hz); },
          [=](RotarySettings& s) { s.chain.low_pass_Hz = corner_Hz; },
          1.5 * open_V * units::turn * frequency_Hz * 3.0 * kConversion_s, 0.015 * open_V};
}

/// A table that creeps in with exp(-t / constant), long after it has arrived: 1 / (1 - lag / constant) of it.
FollowedKey PassedCreep(double corner_Hz) {
  return {fmt::format("a low-pass of {} Hz as a table creeps in", corner_Hz),
          [](Scenario& s) {
            s.effects = {{"settling", "", {{"amplitude", 5.0 * units::arcsec}, {"time_constant", 0.2}}, "test"}};
            RotaryOf(s).adc.samples = kBlockScans;
            RotaryOf(s).procedure.dwell_s = {0.02};
          },
          [=](RotarySettings& s) { s.chain.low_pass_Hz = corner_Hz; }, 1e-6, 20e-6};
}

std::vector<FollowedKey> FollowedKeys(const TemporaryFolder& folder) {
  const auto nothing = [](Scenario&) {};
  const std::string inl = folder.Write("inl.csv", "voltage_V,error_mV\n-10,5\n0,0\n10,5\n");
  return {PassedTone(20, 100),
          PassedTone(20, 1000), PassedTone(137, 100), PassedTone(137, 1000), PassedTone(970, 100),
          PassedTone(970, 1000), PassedCreep(5), PassedCreep(50),
          {"a low-pass behind a signal", [](Scenario& s) { AddTone(s, 137.0, "psd_b_y"); },
           [](RotarySettings& s) { s.chain.low_pass_Hz = 100.0; }, 3e-6, 50e-6},
          {"a converter that is not straight", nothing, [=](RotarySettings& s) { s.adc.inl_file = inl; }, 0.02e-3,
           0.2e-3},
          {"speckle", nothing,
           [](RotarySettings& s) {
             s.grating.speckle_m = 2e-6;
             s.grating.speckle_correlation_rad = 130.0 * units::arcsec;
           },
           2e-6, 2000.0 * 2e-6},
          {"a ruling that an eccentric table moves under the beam",
           [](Scenario& s) { RotaryOf(s).centring_m = {1e-3, 0.5e-3}; },
           [](RotarySettings& s) {
             s.grating.ruling_chirp_per_m = 50e-6 / units::mm;
             s.grating.sphere_m = 100e-9;
           },
           2e-6, 1e-3},
          {"a power that drifts beside a background",
           [](Scenario& s) {
             RotaryOf(s).laser.pitch_rad = 5e-3;
             RotaryOf(s).psd_a.background_A = RotaryOf(s).psd_b.background_A = 100e-6;
           },
           [](RotarySettings& s) { s.laser.power_drift_per_s = -0.3 / units::hour; }, 5e-6, 5e-3}};
}

TEST(RotaryFollow, ShowsWhatAKeyChanges) {
  const TemporaryFolder folder;
  for (const FollowedKey& key : FollowedKeys(folder)) {
    SCOPED_TRACE(key.name);
    Scenario scenario = test::SmallNoiseFree();
    key.prepare(scenario);
    const test::TwinRun before = test::RunTwin(scenario);
    key.change(RotaryOf(scenario));
    const test::TwinRun after = test::RunTwin(scenario);
    const auto follow = [](const test::TwinRun& run) {
      return FollowRotary(run.scenario, run.readings, std::make_shared<DrivesOnce>())->Predict();
    };
    const Eigen::MatrixXd followed_V = follow(after) - follow(before);
    double most_V = 0.0;
    for (std::size_t i = 0; i < after.readings.size(); ++i) {
      for (int c = 0; c < kChannels; ++c) {
        const double shown_V = after.readings[i].mean_V[c] - before.readings[i].mean_V[c];
        EXPECT_NEAR(followed_V(static_cast<Eigen::Index>(i), c), shown_V, key.within_V) << "reading " << i;
        most_V = std::max(most_V, std::abs(shown_V));
      }
    }
    EXPECT_GT(most_V, key.at_least_V);
  }
}

Scenario Bench(const std::string& kind) {
  Scenario s = LoadScenario(test::ScenarioPath("encoder_comparison.toml"), {"encoder_procedure.kind=" + kind});
  s.noise_free = true;
  EncoderOf(s).device.lines = 30;
  EncoderOf(s).device.teeth = 22;
  EncoderOf(s).encoder_procedure.mounting_rad = {0.0, 1.0};
  return s;
}

double Apart_rad(const Scenario& scenario) {
  const std::vector<Reading> readings = test::RunEncoderTwin(scenario).readings;
  const Eigen::MatrixXd followed_rad = FollowEncoder(scenario, readings)->Predict();
  double apart_rad = 0.0;
  for (std::size_t i = 0; i < readings.size(); ++i)
    apart_rad =
        std::max(apart_rad, std::abs(followed_rad(static_cast<Eigen::Index>(i), 0) - readings[i].measured_rad));
  return apart_rad;
}

class EncoderFollowEffect : public testing::TestWithParam<EffectEntry> {};

// Where the reference errs, the shaft's angle is solved for; the rest is rounding of angles of some turns.
TEST_P(EncoderFollowEffect, IsFollowedAtStopsAndInMotion) {
  for (const char* kind : {"stops", "sweep"}) {
    Scenario s = Bench(kind);
    s.effects = {test::PlainEffect(GetParam())};
    EXPECT_LT(Apart_rad(s), 1e-12) << GetParam().name << " " << kind;
  }
}

std::vector<EffectEntry> ForeseeableAngleEffects() {
  std::vector<EffectEntry> entries = EffectCatalogue(kEncoderBench);
  std::erase_if(entries, [](const EffectEntry& e) { return e.name == "outliers"; });
  return entries;
}

INSTANTIATE_TEST_SUITE_P(All, EncoderFollowEffect, testing::ValuesIn(ForeseeableAngleEffects()),
                         [](const auto& tested) { return tested.param.name; });

TEST(EncoderFollow, HasAShaftUnderBothAndADeviceBesideIt) {
  const Scenario s = Bench("stops");
  const std::vector<Reading> readings = test::RunEncoderTwin(s).readings;
  const auto follow = FollowEncoder(s, readings);
  for (const model::Point& point : follow->Points())
    EXPECT_TRUE(model::Slope(*follow, point).isOnes(1e-6)) << point.name;
}

}  // namespace
}  // namespace twinbench::sim
