#include <gmock/gmock.h>

#include "tests/hw_serve/serving.h"

namespace twinbench::test {
namespace {

class Esp : public testing::Test {
 protected:
  ServedTwin served{OnFreePorts(kAtOnce)};
  TcpClient esp{served.at().esp_port};
};

TEST_F(Esp, AMoveIsOrderedWaitedForAndReadBackOnOneLine) {
  EXPECT_EQ(esp.Ask("1PA12.5;1WS;1TP"), "12.5");
  EXPECT_EQ(esp.Ask("1PR-2.25;1WS;1TP?"), "10.25");
  EXPECT_EQ(esp.Ask("1PA?"), "10.25");
  EXPECT_EQ(esp.Ask("1DP?"), "10.25");
  EXPECT_EQ(esp.Ask("2TP?"), "0");
}

TEST_F(Esp, MotionDoneIsInPosition) {
  esp.Send("1PA30\n");
  EXPECT_EQ(esp.Ask("1MD?"), "0");
  int polls = 0;
  while (esp.Ask("1MD?") == "0" && polls < 100) ++polls;
  // 30 deg at 30 deg/s and the window of 0.4 s make 1.4 s: 28 polls of 50 ms, the last one finds it there.
  EXPECT_NEAR(polls, 27, 2);
  EXPECT_EQ(esp.Ask("1TP"), "30");
}

TEST_F(Esp, SoftLimitsRefuseWithTheErrorsOfTheirAxis) {
  esp.Send("2SR45;2SL-45;2PA46\n");
  EXPECT_EQ(esp.Ask("TE?"), "206");
  EXPECT_EQ(esp.Ask("2PA-46;TE?"), "207");
  EXPECT_EQ(esp.Ask("2SL?;2SR?"), "-45");
  EXPECT_EQ(esp.Line(), "45");
  EXPECT_EQ(esp.Ask("2TP"), "0");
  EXPECT_EQ(esp.Ask("TE?"), "0");
}

TEST_F(Esp, MistakesHaveTheNumbersOfTheManualAndAnErrorLineNumberTimeAndText) {
  const std::pair<const char*, const char*> mistakes[] = {
      {"1XX5", "6"},   {"1", "6"},     {"PA5", "37"},       {"1PA", "38"},     {"3PA1", "9"},    {"1PAeast", "101"},
      {"1SN2", "101"}, {"1DH0", "27"}, {"1MF;1PA5", "113"}, {"1MO;99TP", "9"}, {"\x01\x02", "6"}};
  for (const auto& [text, error] : mistakes) EXPECT_EQ(esp.Ask(std::string(text) + ";TE?"), error) << text;
  EXPECT_THAT(esp.Ask("1PA1e9;TB?"), testing::MatchesRegex("106, [0-9]+, POSITIVE SOFTWARE LIMIT DETECTED"));
  EXPECT_THAT(esp.Ask("TB?"), testing::MatchesRegex("0, [0-9]+, NO ERROR DETECTED"));
}

TEST_F(Esp, TheUnitIsTheDegreeAndTheIdentityThatOfTheBench) {
  EXPECT_EQ(esp.Ask("1SN7;1SN?;TE?"), "7");
  EXPECT_EQ(esp.Line(), "0");
  TcpClient scpi(served.at().scpi_port);
  const std::string serial = scpi.Ask("*IDN?").substr(23, 16);
  EXPECT_THAT(esp.Ask("VE?"), testing::AllOf(testing::StartsWith("ESP301"), testing::HasSubstr(serial)));
  EXPECT_THAT(esp.Ask("1ID?"), testing::HasSubstr(serial));
}

}  // namespace
}  // namespace twinbench::test
