#include <gtest/gtest.h>

#include <memory>

#include "tests/investigate/hidden_investigation.h"

namespace twinbench::investigate {
namespace {

Judged Hidden(const std::string& effect, const std::string& where, double rho, double budget_min = 600.0) {
  static const hidden::SignatureScale scale(hidden::Design::kRotary, "");
  InvestigationOptions options;
  options.budget_min = budget_min;
  return InvestigateHidden({effect, where, hidden::Design::kRotary}, 7, rho, scale, options);
}

TEST(Investigate, TellsACauseThatTheFirstRunTiesWithAnother) {
  const Judged judged = Hidden("backlash", "target", 12.0);
  EXPECT_EQ(judged.result, Result::kRight) << judged.answer;
  EXPECT_GT(judged.probability, 0.95);
}

TEST(Investigate, SaysThatWavelengthAndPitchCannotBeTold) {
  const Judged judged = Hidden("wavelength_offset", "", 15.0);
  EXPECT_EQ(judged.result, Result::kRightTie) << judged.answer;
  EXPECT_EQ(judged.investigation.ended, Ended::kNothingMore);
}

TEST(Investigate, EndsWithItsBudget) {
  const Judged judged = Hidden("backlash", "target", 12.0, 1.0);
  EXPECT_EQ(judged.investigation.steps.size(), 1u);  // the scenario's own run is made in any case
  ASSERT_TRUE(judged.tied_at_first) << judged.answer;
  EXPECT_EQ(judged.investigation.ended, Ended::kBudget);
}

}  // namespace
}  // namespace twinbench::investigate
