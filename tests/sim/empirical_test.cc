#include <gtest/gtest.h>

#include "tests/support/small_scenario.h"
#include "tests/support/twin_run.h"

namespace twinbench::sim {
namespace {

TEST(Empirical, AddsItsValuesAtItsReadingsAndNothingElse) {
  Scenario scenario = test::SmallNoiseFree();
  const auto plain = test::RunTwin(scenario).readings;
  EmpiricalSettings empirical;
  empirical.channel = "psd_b_y";
  empirical.reading = {40, 41, 63};
  empirical.value_m = {1e-6, -2e-6, 0.5e-6};
  scenario.empiricals = {empirical};
  const auto extended = test::RunTwin(scenario).readings;
  ASSERT_EQ(plain.size(), extended.size());
  for (std::size_t k = 0; k < plain.size(); ++k) {
    for (std::size_t c = 0; c < kChannels; ++c) {
      double expected_m = 0.0;
      for (std::size_t i = 0; i < 3; ++i) {
        if (c == 3 && plain[k].reading == empirical.reading[i]) expected_m = empirical.value_m[i];
      }
      // Doubles of the order of 1 V.
      EXPECT_NEAR(extended[k].mean_V[c] - plain[k].mean_V[c], 2000.0 * expected_m, 1e-12) << k;
    }
  }
}

}  // namespace
}  // namespace twinbench::sim
