#include <gtest/gtest.h>

#include "tests/support/angle_benches.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/encoder_comparison/twin/follow.h"

namespace twinbench::sim {
namespace {

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
