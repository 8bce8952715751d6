#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/twin_run.h"
#include "twin/benches/rotary_4dof/diagnosis/search.h"
#include "twin/benches/rotary_4dof/twin/factory.h"

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
  ASSERT_EQ(found.terms.size(), 1U);
  const Term& term = found.terms[0];
  EXPECT_EQ(searched.rotary->Families()[static_cast<std::size_t>(term.family)].effect, "incidence_offset");
  EXPECT_NEAR(term.amplitudes[0], kIncidence_rad, 4.0 * std::sqrt(term.cov(0, 0)));
  EXPECT_LT(std::sqrt(term.cov(0, 0)), 0.1 * kIncidence_rad);
}

}  // namespace
}  // namespace twinbench::diagnose
