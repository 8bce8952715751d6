#include <gmock/gmock.h>

#include "tests/hw_serve/serving.h"
#include "tests/support/rotary_scenario.h"

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
  {
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
}

TEST_F(Scpi, OneLineOfQueriesHasOneLineOfAnswers) {
  EXPECT_EQ(scpi.Ask("ROT1:LIM:LOW -10;UPP 20; :ROT1:LIM:LOW?;UPP?"), "-10;20");
  EXPECT_THAT(scpi.Ask("ROT2:ANGL?;*IDN?"), StartsWith("0;twinbench,"));
  EXPECT_THAT(Error(), StartsWith("0,"));
}

TEST_F(Scpi, AMoveBeyondASoftLimitIsRefusedAndTheTableStays) {
  scpi.Send("ROT1:LIM:UPP 20\nROT1:ANGL 20.5\n");
  EXPECT_THAT(Error(), StartsWith("-222,\"Data out of range"));
  EXPECT_EQ(scpi.Ask("ROT1:STAT?"), "0,0,0,1,1,0,\"\"");
}

TEST_F(Scpi, MistakesAreQueuedAndAnswerNothing) {
  const std::pair<const char*, const char*> mistakes[] = {
      {"NONSENSE", "-113,"},         {"ROT1:ANGL:", "-102,"},     {"ROT1:ANGL", "-109,"},
      {"ROT1:ANGL 1,2", "-108,"},    {"ROT1:ANGL east", "-120,"}, {"ROT1:ANGL nan", "-120,"},
      {"ROT3:ANGL?", "-114,"},       {"ROT1:SETT? -1", "-222,"},  {"CLOC:HOLD MAYBE", "-224,"},
      {"SIM:FAUL adc,fire", "-224"}, {"FIXT:MOUN 1,0", "-109,"},  {"CLOC:WAIT? 1.5", "-120,"}};
  for (const auto& [text, error] : mistakes) {
    scpi.Send(std::string(text) + "\n");
    EXPECT_THAT(Error(), StartsWith(error)) << text;
  }
  EXPECT_THAT(Error(), StartsWith("0,"));
}

TEST_F(Scpi, AMistakeInALineLeavesItsOtherCommandsAlone) {
  EXPECT_EQ(scpi.Ask("ROT1:LIM:UPP?;NONSENSE;ROT1:LIM:UPP 5;UPP?").substr(0, 2), "57");  // 1e4 rad = 572958 deg
  EXPECT_THAT(Error(), StartsWith("-113,"));
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

TEST_F(Scpi, TimePassesByAsMuchAsIsAskedFor) {
  const long long before = scpi.AskNumber("CLOC:NOW?");
  EXPECT_EQ(scpi.AskNumber("CLOC:WAIT? 123456789"), before + 123456789);
  EXPECT_EQ(scpi.AskNumber("SIM:REST;CLOC:NOW?"), 0);
}

}  // namespace
}  // namespace twinbench::test
