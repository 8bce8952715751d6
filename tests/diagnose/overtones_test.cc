#include <gtest/gtest.h>

#include <cmath>

#include "tests/diagnose/told.h"
#include "tests/diagnose/turntable_bench.h"
#include "twin/benches/registry.h"
#include "twin/core/stream.h"
#include "twin/diagnose/diagnose.h"

// Waves in time on a bench that shares nothing with the twin: a sine is a tone; what switches is not.
namespace twinbench::diagnose::turntable {
namespace {

using units::arcsec;

constexpr double kPeriod_s = 260.0;

double Sine(double turns) {
  return std::sin(2.0 * M_PI * turns);
}
double Switching(double turns) {
  return turns - std::floor(turns) < 0.4 ? 1.0 : 0.0;
}

Diagnosis DiagnosisWith(double (*wave)(double), double size_rad, std::uint64_t seed) {
  const Scenario scenario = test::CarefulScenario();
  std::vector<Reading> readings = test::BenchReadings(scenario, {}, seed);
  for (Reading& r : readings) r.autocollimator_yaw_rad += size_rad * wave(ToSeconds(r.time) / kPeriod_s + 0.13);
  DiagnoseOptions options;
  options.cache_folder = testing::TempDir() + "turntable_null";
  return Diagnose(readings, scenario, options).diagnosis;
}

TEST(Overtones, ASineStaysATone) {
  for (const std::uint64_t seed : {31u, 32u, 33u}) {
    const Diagnosis d = DiagnosisWith(Sine, 0.25 * arcsec, seed);
    ASSERT_EQ(d.verdict, Verdict::kNamed) << seed;
    EXPECT_EQ(d.causes.front().effect, "tone");
    EXPECT_GT(d.causes.front().probability, 0.9);
  }
}

TEST(Overtones, WhatSwitchesIsNoTone) {
  for (const std::uint64_t seed : {31u, 32u, 33u}) {
    const Diagnosis d = DiagnosisWith(Switching, 0.3 * arcsec, seed);
    EXPECT_EQ(d.verdict, Verdict::kUnknown) << seed;
    EXPECT_GT(d.unknown.probability, 0.5) << seed;
  }
}

// Fainter by a third: the first of these is told by where a rectangle has its overtones only.
TEST(Overtones, WhatSwitchesFaintlyIsNoToneEither) {
  for (const std::uint64_t seed : {32u, 33u, 34u})
    EXPECT_GT(DiagnosisWith(Switching, 0.2 * arcsec, seed).unknown.probability, 0.7) << seed;
}

}  // namespace
}  // namespace twinbench::diagnose::turntable
