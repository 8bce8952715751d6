#include "twin/uncertainty/one_at_a_time.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/uncertainty/stated.h"

namespace twinbench::uncertainty {
namespace {

using test::Input, test::InputKeys;

Contribution Of(std::size_t k) {
  return {InputKeys()[k], [k](Scenario& s) {
            Scenario usual = test::FourInputs({});
            NumbersAt(s, InputKeys()[k])[0] = NumbersAt(usual, InputKeys()[k])[0];
          }};
}

/// Errors of 3 and 4 um in the first two.
Scenario OfThreeAndFour() {
  Scenario scenario = test::FourInputs({});
  NumbersAt(scenario, InputKeys()[0])[0] += 3e-3;
  NumbersAt(scenario, InputKeys()[1])[0] += 4e-3;
  return scenario;
}

TEST(OneAtATime, SharesOutWhatAddsInQuadrature) {
  const auto run = [](const Scenario& s) {
    return std::vector<Figure>{{"sd", std::hypot(1e3 * Input(s, 0), 1e3 * Input(s, 1))}};
  };
  const OneAtATime found = RunOneAtATime(OfThreeAndFour(), {Of(0), Of(1), Of(2)}, run);
  EXPECT_NEAR(found.total.at(0).value, 5.0, 1e-9);
  EXPECT_NEAR(found.none.at(0), 0.0, 1e-9);
  ASSERT_EQ(found.shares.size(), 2U) << "the third changes nothing";
  EXPECT_NEAR(found.shares[0].alone.at(0), 3.0, 1e-9);
  EXPECT_NEAR(found.shares[0].without.at(0), 4.0, 1e-9);
  EXPECT_NEAR(found.InQuadrature(0), 5.0, 1e-9);
}

/// A converter without the noise that stays would round the other away.
TEST(OneAtATime, KeepsWhatStaysBesideEveryOther) {
  const auto run = [](const Scenario& s) {
    const double noise = 1e3 * Input(s, 1);
    return std::vector<Figure>{{"sd", noise > 1e-9 ? std::hypot(1e3 * Input(s, 0), noise) : 0.0}};
  };
  Contribution noise = Of(1);
  noise.stays = true;
  const OneAtATime found = RunOneAtATime(OfThreeAndFour(), {Of(0), noise}, run);
  EXPECT_NEAR(found.none.at(0), 4.0, 1e-9);
  EXPECT_NEAR(found.shares[0].alone.at(0), 5.0, 1e-9);
  EXPECT_TRUE(found.shares[1].alone.empty());
  EXPECT_NEAR(found.InQuadrature(0), 5.0, 1e-9);
}

}  // namespace
}  // namespace twinbench::uncertainty
