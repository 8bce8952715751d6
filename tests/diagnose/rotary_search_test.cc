#include "twin/diagnose/rotary_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/twin_run.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

namespace twinbench::diagnose {
namespace {

/// One degree: the tangent at zero is off by a fifth of what the free unknowns leave of the effect.
constexpr double kIncidence_rad = 17e-3;

TEST(RotarySearch, NamesAChangeOfTheBenchThatIsLargeEnoughToBend) {
  const Scenario believed = LoadScenario(twinbench::test::ScenarioPath("rotary_4dof.toml"));
  Scenario actual = believed;
  actual.effects.push_back({"incidence_offset", "", {{"incidence", kIncidence_rad}}, ""});
  DiagnoseOptions options;
  options.null_runs = 100;
  const SearchedRotary searched =
      SearchRotary(twinbench::test::RunTwin(actual).readings, believed, options, {benches::rotary::FollowRecord});
  const SearchResult& found = searched.analysis.found;
  ASSERT_EQ(found.picks.size(), 1U);
  const Pick& pick = found.picks[0];
  EXPECT_EQ(searched.rotary->Families()[static_cast<std::size_t>(pick.family)].effect, "incidence_offset");
  EXPECT_NEAR(pick.amplitudes[0], kIncidence_rad, 4.0 * std::sqrt(pick.cov(0, 0)));
  EXPECT_LT(std::sqrt(pick.cov(0, 0)), 0.1 * kIncidence_rad);
}

}  // namespace
}  // namespace twinbench::diagnose
