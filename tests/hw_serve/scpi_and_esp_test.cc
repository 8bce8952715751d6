#include "hw_bridge/serve/scpi_text.h"
#include "tests/hw_serve/serving.h"

namespace twinbench::test {
namespace {

using testing::ElementsAre, testing::HasSubstr;

TEST(ServedBench, NamesItselfBySerialNumberOfItsScenario) {
  const ServedTwin served(OnFreePorts(kAtOnce));
  const std::string name = served.Ask("*IDN?");
  EXPECT_THAT(name, testing::MatchesRegex("twinbench,rotary-bench,[0-9A-F]{16},[0-9.]+"));
  TcpClient esp(served.at().esp_port);
  EXPECT_THAT(esp.Ask("VE?"), testing::AllOf(testing::StartsWith("ESP301"), HasSubstr(name.substr(23, 16))));
  EXPECT_THAT(esp.Ask("1ID?"), HasSubstr(name.substr(23, 16)));
  Scenario other = test::RotaryScenario();
  EXPECT_EQ(ServedTwin(OnFreePorts(kAtOnce), other).Ask("*IDN?"), name);
  other.seed = 2;
  EXPECT_NE(ServedTwin(OnFreePorts(kAtOnce), other).Ask("*IDN?"), name);
}

TEST(ScpiText, AKeywordIsItsShortOrItsLongFormInAnyCaseAndANumberBehindItIsOneIfItIsLeftOut) {
  for (const char* form : {"ANGL", "ANGLe", "angle", "Angl"}) EXPECT_EQ(hw::MatchKeyword("ANGLe", form), 0) << form;
  for (const char* form : {"ANG", "ANGLES", "ANGL1", ""})
    EXPECT_EQ(hw::MatchKeyword("ANGLe", form), std::nullopt) << form;
  EXPECT_EQ(hw::MatchKeyword("ROTation#", "rot"), 1);
  EXPECT_EQ(hw::MatchKeyword("ROTation#", "ROTATION2"), 2);
  EXPECT_EQ(hw::MatchKeyword("ROTation#", "ROT2x"), std::nullopt);
  EXPECT_EQ(hw::MatchKeyword("ROTation#", "ROT99999999999999999999"), std::nullopt);
}

TEST(ScpiText, AUnitIsHeaderQuestionMarkAndParametersAndNoneWithoutAHeader) {
  const auto unit = hw::ParseScpiUnit("SIM:FAUL adc , \"a,b\",3");
  ASSERT_TRUE(unit);
  EXPECT_THAT(unit->header, ElementsAre("SIM", "FAUL"));
  EXPECT_THAT(unit->parameters, ElementsAre("adc", "\"a,b\"", "3"));
  EXPECT_FALSE(unit->query);
  EXPECT_TRUE(hw::ParseScpiUnit("*IDN?")->query);
  EXPECT_TRUE(hw::ParseScpiUnit(":ROT1:ANGL?")->rooted);
  for (const char* text : {"", "?", ":", "A::B", "ROT1:", "**IDN?", "R\x01T", "=", "ROT(1)"})
    EXPECT_FALSE(hw::ParseScpiUnit(text)) << text;
}

TEST(ScpiText, TheErrorQueueIsBoundedAndSaysWhenItOverflowed) {
  hw::ScpiErrorQueue queue;
  for (int k = 0; k < 1000; ++k) queue.Add({-113, ""});
  std::vector<std::string> entries;
  for (std::string entry = queue.Next(); entry != "0,\"No error\""; entry = queue.Next()) entries.push_back(entry);
  ASSERT_EQ(entries.size(), 20u);
  EXPECT_EQ(entries.front(), "-113,\"Undefined header\"");
  EXPECT_EQ(entries.back(), "-350,\"Queue overflow\"");
}

}  // namespace
}  // namespace twinbench::test
