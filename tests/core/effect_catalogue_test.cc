#include "twin/core/effect_catalogue.h"

#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "tests/support/kept_text.h"
#include "twin/benches/names.h"
#include "twin/core/bench_format.h"
#include "twin/core/units.h"

namespace twinbench {
namespace {

using testing::ElementsAre;

TEST(EffectCatalogue, HasTheEffectsOfItsBenchOnly) {
  for (const std::string& bench : BenchNames()) {
    std::set<std::string> names;
    for (const EffectEntry& entry : EffectCatalogue(bench)) names.insert(entry.name);
    EXPECT_KEPT(fmt::format("{}: {}", bench, fmt::join(names, ", ")));
  }
  EXPECT_EQ(FindEffect("psd_gain", "encoder_comparison"), nullptr);
  EXPECT_THROW(EffectCatalogue("lathe"), InputError);
}

TEST(EffectCatalogue, SaysWhereAnEffectCanActAndGivesKeysOfItsParametersTheirUnitAndValuesInSI) {
  EXPECT_THAT(FindEffect("psd_gain", kRotaryBench)->places,
              ElementsAre("psd_a_x", "psd_a_y", "psd_b_x", "psd_b_y"));
  EXPECT_THAT(FindEffect("laser_drift", kRotaryBench)->places, ElementsAre("yaw", "pitch"));
  EXPECT_THAT(FindEffect("slip", kRotaryBench)->places, ElementsAre("yaw", "tilt", "lateral"));
  EXPECT_TRUE(FindEffect("wavelength_offset", kRotaryBench)->places.empty());
  EXPECT_EQ(FindEffect("backlash", kRotaryBench)->default_place, "target");
  EXPECT_EQ(FindEffect("no_such_effect", kRotaryBench), nullptr);
  const auto& parameters = FindEffect("slip", kRotaryBench)->parameters;
  EXPECT_TRUE(parameters[0].BelongsTo("yaw"));
  EXPECT_FALSE(parameters[0].BelongsTo("lateral"));
  EXPECT_TRUE(parameters[2].BelongsTo("lateral"));
  const EffectParameter& roll = FindEffect("psd_roll", kRotaryBench)->parameters.front();
  EXPECT_EQ(roll.Key(), "roll_mrad");
  EXPECT_EQ(roll.default_SI, 5.0 * units::mrad);
  EXPECT_EQ(FindEffect("psd_gain", kRotaryBench)->parameters.front().Key(), "gain_error");
  const EffectParameter& drift = FindEffect("laser_drift", kRotaryBench)->parameters.front();
  EXPECT_EQ(drift.Key(), "drift_urad_per_h");
  EXPECT_DOUBLE_EQ(drift.default_SI, 20e-6 / 3600.0);
}

class EveryBench : public testing::TestWithParam<std::string> {};

TEST_P(EveryBench, HasDefaultsWithinBoundsAndPlacesThatExist) {
  for (const EffectEntry& entry : EffectCatalogue(GetParam())) {
    const std::set<std::string> places(entry.places.begin(), entry.places.end());
    EXPECT_FALSE(entry.title.empty()) << entry.name;
    EXPECT_TRUE(entry.default_place.empty() || places.contains(entry.default_place)) << entry.name;
    for (const EffectParameter& parameter : entry.parameters) {
      EXPECT_TRUE(std::isfinite(parameter.default_SI)) << entry.name << " " << parameter.name;
      EXPECT_LE(parameter.lower_SI, parameter.default_SI) << entry.name << " " << parameter.name;
      EXPECT_GE(parameter.upper_SI, parameter.default_SI) << entry.name << " " << parameter.name;
      for (const std::string& place : parameter.only_at) EXPECT_TRUE(places.contains(place)) << entry.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EffectCatalogue, EveryBench, testing::ValuesIn(BenchNames()));

}  // namespace
}  // namespace twinbench
