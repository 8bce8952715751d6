#include <gmock/gmock.h>

#include <cmath>

#include "tests/core/input_error.h"
#include "tests/core/refusals.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"

/// What a diagnosis adds to a scenario: findings in [[effect]] blocks, and [[empirical]] blocks.
namespace twinbench {
namespace {

using testing::ElementsAre;

Scenario ParseFinding(const std::string& text) {
  return ParseScenario("bench = \"rotary_4dof\"\n" + text, "s.toml", ".");
}
std::string FindingError(const std::string& text) {
  return MessageOf([&] { ParseFinding(text); });
}

TEST(ScenarioFinding, TakesUncertaintiesToSIKeepsTheRestAndIsNotNeeded) {
  const Scenario s = ParseFinding(
      "[[effect]]\nname = \"psd_roll\"\nwhere = \"psd_a\"\nroll_mrad = 2\nu_roll_mrad = 0.1\n"
      "log_evidence = 31.5\nprobability = 0.97\nprovenance = \"run 7\"\n");
  const EffectFinding& finding = s.effects.at(0).finding;
  EXPECT_EQ(finding.u.at("roll"), 0.1 * units::mrad);
  EXPECT_EQ(finding.log_evidence, 31.5);
  EXPECT_EQ(finding.probability, 0.97);
  EXPECT_EQ(finding.provenance, "run 7");
  const Scenario without = ParseFinding("[[effect]]\nname = \"psd_roll\"\nwhere = \"psd_a\"\n");
  EXPECT_TRUE(without.effects.at(0).finding.u.empty());
  EXPECT_TRUE(std::isnan(without.effects.at(0).finding.probability));
}

TEST(ScenarioFinding, RefusesWhatCannotBe) {
  const std::string roll = "[[effect]]\nname = \"psd_roll\"\nwhere = \"psd_a\"\n";
  ExpectRefused(
      "s.toml", FindingError,
      {{5, roll + "u_roll_mrad = -1\n"}, {5, roll + "probability = 1.5\n"}, {5, roll + "u_gain_error = 1\n"}});
}

constexpr const char* kEmpirical =
    "[[empirical]]\nsignature = \"order 7\"\nchannel = \"psd_b_y\"\nreading = [3, 5]\nvalue_um = [0.5, -0.25]\n";

TEST(ScenarioEmpirical, IsTabulatedByReadingOrByTime) {
  const EmpiricalSettings by_reading = ParseFinding(kEmpirical).empiricals.at(0);
  EXPECT_EQ(by_reading.signature, "order 7");
  EXPECT_EQ(by_reading.channel, "psd_b_y");
  EXPECT_THAT(by_reading.reading, ElementsAre(3, 5));
  EXPECT_THAT(by_reading.value_m, ElementsAre(0.5 * units::um, -0.25 * units::um));
  const std::string timed = "channel = \"psd_b_y\"\nby = \"time\"\ntime_s = [1.5, 2]\nvalue_um = [0.5, 1]\n";
  const EmpiricalSettings by_time = ParseFinding("[[empirical]]\n" + timed).empiricals.at(0);
  EXPECT_EQ(by_time.by, "time");
  EXPECT_THAT(by_time.time_s, ElementsAre(1.5, 2.0));
  EXPECT_THAT(by_time.reading, testing::IsEmpty());
}

TEST(ScenarioEmpirical, RefusesATableThatDoesNotFit) {
  const std::string x = "[[empirical]]\nchannel = \"psd_a_x\"\n", by_time = x + "by = \"time\"\n";
  ExpectRefused("s.toml", FindingError,
                {{2, x + "reading = [1, 2]\nvalue_um = [1.0]\n"},
                 {2, x + "reading = [1, 1]\nvalue_um = [1.0, 2.0]\n"},
                 {2, x + "reading = [1]\nvalue_deg = [1.0]\n"},
                 {2, "[[empirical]]\nchannel = \"angle\"\nreading = [1]\nvalue_deg = [1.0]\n"},
                 {2, by_time + "time_s = [2, 1]\nvalue_um = [1.0, 2.0]\n"},
                 {2, by_time + "time_s = [2]\nvalue_um = [1.0, 2.0]\n"},
                 {2, by_time + "time_s = [2]\nreading = [1]\nvalue_um = [1.0]\n"},
                 {2, x + "reading = [1, 2]\ntime_s = [1]\nvalue_um = [1, 2]\n"},
                 {3, "[[empirical]]\nchanel = \"psd_a_x\"\n"}});
}

}  // namespace
}  // namespace twinbench
