#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "twin/benches/names.h"
#include "twin/benches/registry.h"
#include "twin/core/units.h"
#include "twin/diagnose/diagnose.h"

namespace twinbench::diagnose::encoder {
namespace {

using units::deg;

/// Two turns in the passes + - - +, 72 stops a turn, white noise of 0.002 deg.
std::vector<Reading> Comparison(double (*error_deg)(double angle_rad)) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise_deg(0.0, 0.002);
  std::vector<Reading> readings;
  int pass = 0;
  for (const int direction : {1, -1, -1, 1}) {
    for (int k = 0; k < 144; ++k) {
      Reading r;
      r.reading = static_cast<int>(readings.size());
      r.time = Time(FromSeconds(4.0 * r.reading));
      r.pass = pass;
      r.direction = direction;
      r.position = direction > 0 ? k : 143 - k;
      r.reference_rad = r.position * 5.0 * deg;
      r.measured_rad = r.reference_rad + (error_deg(r.reference_rad) + noise_deg(random)) * deg;
      readings.push_back(r);
    }
    ++pass;
  }
  return readings;
}

TEST(EncoderDiagnosis, NamesSeveralStrongOrdersAtOnceAndNoLineBetweenThem) {
  const auto readings = Comparison([](double th) {
    return 0.5 * std::cos(th + 0.7) + 0.3 * std::cos(2.0 * th - 0.4) + 0.05 * std::cos(7.0 * th + 1.9);
  });
  Scenario scenario;
  scenario.bench = kEncoderBench;
  const Diagnosis d = Diagnose(readings, scenario).diagnosis;
  EXPECT_NE(d.verdict, Verdict::kUnknown) << d.unknown.signature;
  for (const char* effect : {"eccentricity", "ellipticity", "periodic"})
    EXPECT_TRUE(std::ranges::count(d.causes, effect, &Cause::effect)) << effect;
}

TEST(EncoderDiagnosis, OrdersThatTheReadingsDoNotTellApartGetNoSizes) {
  auto readings = Comparison([](double th) { return 0.02 * std::cos(30.0 * th); });
  Scenario scenario;
  scenario.bench = kEncoderBench;
  EXPECT_FALSE(Diagnose(readings, scenario).diagnosis.harmonics.empty());
  std::erase_if(readings, [](const Reading& r) { return r.position > 20; });  // 100 of 360 deg
  EXPECT_TRUE(Diagnose(readings, scenario).diagnosis.harmonics.empty());
}

TEST(EncoderDiagnosis, StillFindsALineBetweenTheOrders) {
  const auto readings = Comparison([](double th) { return 0.05 * std::cos(3.4 * th + 0.7); });
  Scenario scenario;
  scenario.bench = kEncoderBench;
  const Diagnosis d = Diagnose(readings, scenario).diagnosis;
  EXPECT_EQ(d.verdict, Verdict::kUnknown);
  EXPECT_NE(d.unknown.signature.find("line at 3.4"), std::string::npos) << d.unknown.signature;
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
