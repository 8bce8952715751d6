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

TEST(EffectCatalogue, HasTheEffectsOfItsBenchOnly) {
  for (const std::string& bench : BenchNames()) {
    std::set<std::string> names;
    for (const EffectEntry& entry : EffectCatalogue(bench)) names.insert(entry.name);
    EXPECT_KEPT(fmt::format("{}: {}", bench, fmt::join(names, ", ")));
  }
  EXPECT_EQ(FindEffect("psd_gain", "encoder_comparison"), nullptr);
  EXPECT_THROW(EffectCatalogue("lathe"), InputError);
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
