#include "hw_bridge/serve/scpi_text.h"
#include "tests/hw_serve/serving.h"

namespace twinbench::test {
namespace {

using testing::StartsWith;

class Scpi : public testing::Test {
 protected:
  ServedTwin served{OnFreePorts(kAtOnce)};
  TcpClient scpi{served.at().scpi_port};

  std::string Error() { return scpi.Ask("SYST:ERR?"); }
};

TEST_F(Scpi, TheBenchNamesItselfBySerialNumberOfItsScenario) {
  const std::string name = scpi.Ask("*IDN?");
  EXPECT_THAT(name, testing::MatchesRegex("twinbench,rotary-bench,[0-9A-F]{16},[0-9.]+"));
  Scenario other = test::RotaryScenario();
  other.seed = 2;
  EXPECT_EQ(TcpClient(ServedTwin(OnFreePorts(kAtOnce)).at().scpi_port, 0).Ask("*IDN?"), name);
  ServedTwin second(OnFreePorts(kAtOnce), other);
  EXPECT_NE(TcpClient(second.at().scpi_port).Ask("*IDN?"), name);
}

TEST_F(Scpi, OneClientHoldsTheClock) {
  EXPECT_EQ(scpi.Ask("CLOC:HOLD ON;*OPC?"), "1");
  TcpClient other(served.at().scpi_port);
  for (const char* command : {"CLOC:HOLD ON", "SIM:REST", "SIM:PACE OFF"}) {
    other.Send(std::string(command) + "\n");
    EXPECT_EQ(other.Ask("SYST:ERR?"), "-221,\"Settings conflict;another client holds the clock\"") << command;
  }
  EXPECT_EQ(Error(), "0,\"No error\"");
  EXPECT_EQ(scpi.Ask("CLOC:HOLD OFF;*OPC?"), "1");
  other.Send("CLOC:HOLD ON\n");
  EXPECT_EQ(other.Ask("SYST:ERR?"), "0,\"No error\"") << "it is free again";
}

TEST_F(Scpi, OneLineOfQueriesHasOneLineOfAnswersAndAMoveBeyondASoftLimitIsRefused) {
  EXPECT_EQ(scpi.Ask("ROT1:LIM:LOW -10;UPP 20; :ROT1:LIM:LOW?;UPP?"), "-10;20");
  EXPECT_THAT(scpi.Ask("ROT2:ANGL?;*IDN?"), StartsWith("0;twinbench,"));
  EXPECT_THAT(Error(), StartsWith("0,"));
  scpi.Send("ROT1:ANGL 20.5\n");
  EXPECT_THAT(Error(), StartsWith("-222,\"Data out of range"));
  EXPECT_EQ(scpi.Ask("ROT1:STAT?"), "0,0,0,1,1,0,\"\"") << "the table stays";
}

TEST_F(Scpi, MistakesAreQueuedAnswerNothingAndLeaveOtherCommandsOfTheirLineAlone) {
  const std::pair<const char*, const char*> mistakes[] = {
      {"NONSENSE", "-113,"},         {"ROT1:ANGL:", "-102,"},     {"ROT1:ANGL", "-109,"},
      {"ROT1:ANGL 1,2", "-108,"},    {"ROT1:ANGL east", "-120,"}, {"ROT1:ANGL nan", "-120,"},
      {"ROT3:ANGL?", "-114,"},       {"ROT1:SETT? -1", "-222,"},  {"CLOC:HOLD MAYBE", "-224,"},
      {"SIM:FAUL adc,fire", "-224"}, {"FIXT:MOUN 1,0", "-109,"},  {"CLOC:WAIT? 1.5", "-120,"}};
  for (const auto& [text, error] : mistakes) {
    scpi.Send(std::string(text) + "\n");
    EXPECT_THAT(Error(), StartsWith(error)) << text;
  }
  EXPECT_EQ(scpi.Ask("ROT1:LIM:UPP?;NONSENSE;ROT1:LIM:UPP 5;UPP?").substr(0, 2), "57");  // 1e4 rad = 572958 deg
  EXPECT_THAT(Error(), StartsWith("-113,"));
  EXPECT_THAT(Error(), StartsWith("0,"));
}

TEST_F(Scpi, TheEventRegisterTellsCommandFromExecutionErrors) {
  EXPECT_EQ(scpi.Ask("*ESR?"), "128");  // power on
  scpi.Send("NONSENSE\n");
  EXPECT_EQ(scpi.Ask("*ESR?"), "32");
  scpi.Send("*ESE 16;*SRE 32;CLOC:HOLD MAYBE\n");
  EXPECT_EQ(scpi.Ask("*STB?"), "100");  // error queue 4, event summary 32, service request 64
  scpi.Send("*CLS\n");
  EXPECT_EQ(scpi.Ask("*STB?"), "0");
}

using testing::ElementsAre;

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
