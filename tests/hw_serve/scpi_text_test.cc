#include "hw_bridge/serve/scpi_text.h"

#include <gmock/gmock.h>

namespace twinbench::hw {
namespace {

using testing::ElementsAre;

TEST(ScpiText, AKeywordIsItsShortOrItsLongFormInAnyCaseAndANumberBehindItIsOneIfItIsLeftOut) {
  for (const char* form : {"ANGL", "ANGLe", "angle", "Angl"}) EXPECT_EQ(MatchKeyword("ANGLe", form), 0) << form;
  for (const char* form : {"ANG", "ANGLES", "ANGL1", ""})
    EXPECT_EQ(MatchKeyword("ANGLe", form), std::nullopt) << form;
  EXPECT_EQ(MatchKeyword("ROTation#", "rot"), 1);
  EXPECT_EQ(MatchKeyword("ROTation#", "ROTATION2"), 2);
  EXPECT_EQ(MatchKeyword("ROTation#", "ROT2x"), std::nullopt);
  EXPECT_EQ(MatchKeyword("ROTation#", "ROT99999999999999999999"), std::nullopt);
}

TEST(ScpiText, AUnitIsHeaderQuestionMarkAndParametersAndNoneWithoutAHeader) {
  const auto unit = ParseScpiUnit("SIM:FAUL adc , \"a,b\",3");
  ASSERT_TRUE(unit);
  EXPECT_THAT(unit->header, ElementsAre("SIM", "FAUL"));
  EXPECT_THAT(unit->parameters, ElementsAre("adc", "\"a,b\"", "3"));
  EXPECT_FALSE(unit->query);
  EXPECT_TRUE(ParseScpiUnit("*IDN?")->query);
  EXPECT_TRUE(ParseScpiUnit(":ROT1:ANGL?")->rooted);
  for (const char* text : {"", "?", ":", "A::B", "ROT1:", "**IDN?", "R\x01T", "=", "ROT(1)"})
    EXPECT_FALSE(ParseScpiUnit(text)) << text;
}

TEST(ScpiText, TheErrorQueueIsBoundedAndSaysWhenItOverflowed) {
  ScpiErrorQueue queue;
  for (int k = 0; k < 1000; ++k) queue.Add({-113, ""});
  std::vector<std::string> entries;
  for (std::string entry = queue.Next(); entry != "0,\"No error\""; entry = queue.Next()) entries.push_back(entry);
  ASSERT_EQ(entries.size(), 20u);
  EXPECT_EQ(entries.front(), "-113,\"Undefined header\"");
  EXPECT_EQ(entries.back(), "-350,\"Queue overflow\"");
}

}  // namespace
}  // namespace twinbench::hw
