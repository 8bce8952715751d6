#include "hw_bridge/serve/esp_machine_conversation.h"
#include "hw_bridge/serve/scpi_commands.h"
#include "tests/hw_serve/serving.h"
#include "tests/hw_serve/virtual_bench.h"

/// Who may move and spoil what is served, where a token is asked for.
namespace twinbench::test {
namespace {

TEST(Guarded, ItsBenchFileCarriesTheTokenOnEveryConnection) {
  hw::ServeOptions options = OnFreePorts(kAtOnce);
  options.token = kToken;
  const ServedTwin served(options);
  for (const char* tables : {"scpi", "esp", "pty"}) {
    const std::string text = hw::WriteServedBenchFile(served.at(), tables);
    EXPECT_THROW(OpenHardware(hw::ParseBenchFile(text, "bench.toml", "."), RotaryScenario()), BenchError) << tables;
    const auto bench = OpenHardware(hw::ParseBenchFile(hw::WithGuards(text, kToken), "bench.toml", "."), RotaryScenario());
    bench->Bench().target.StartMove(0.1);
    EXPECT_TRUE(bench->Bench().target.Settles(std::chrono::minutes(1))) << tables;
    EXPECT_THROW(OpenHardware(hw::ParseBenchFile(hw::WithGuards(text, "wrong"), "bench.toml", "."), RotaryScenario()),
                 BenchError);
  }
}

// A command that somebody adds is protected unless it is one of these.
TEST(Unguarded, OnlyStatusAndStopsAreOpenToAll) {
  for (const auto family : {hw::ScpiTableCommands(), hw::ScpiInstrumentCommands(), hw::ScpiMachineCommands(), hw::ScpiTimeCommands()}) {
    for (const hw::ScpiCommand& command : family)
      EXPECT_EQ(hw::IsOpenToAll(command), command.query || std::string(command.header) == "ROTation#:STOP") << command.header;
  }
  for (const char* name : {"PA", "PR", "OR", "DH", "SL", "SR", "MO", "MF", "HL", "HC", "HV", "XT"})
    EXPECT_FALSE(hw::IsEspOpenToAll(name, false)) << name;
  for (const char* name : {"ST", "AB", "HS", "WS", "WT"}) EXPECT_TRUE(hw::IsEspOpenToAll(name, false)) << name;
}

// What becomes of tables that move when whoever moved them is gone. The twin runs in real time; a move of 100 deg takes it four seconds.

using std::chrono::milliseconds;

template <class Client>
bool Moves(Client& looker) {
  return looker.Ask("ROT1:STAT?").find(",1,0,1,0,") != std::string::npos;
}

/// Whether it comes to rest long before its time.
bool IsStopped(TcpClient& looker) {
  for (int k = 0; k < 40 && Moves(looker); ++k) std::this_thread::sleep_for(milliseconds(20));
  return !Moves(looker) && std::stod(looker.Ask("ROT1:ANGL?")) < 60.0;
}

class Missed : public testing::Test {
 protected:
  ServedTwin served_{OnFreePorts(1.0)};
  TcpClient looker_{served_.at().scpi_port};
};

TEST_F(Missed, AClientThatArmedItAndIsGoneStopsWhatMoves) {
  for (const bool armed : {false, true}) {
    VirtualBench bench(1.0);
    VirtualScpi looker(bench);
    {
      VirtualScpi mover(bench);
      mover.Ask(armed ? "SYST:WATC 100;WATC?" : "SYST:WATC?");
      mover.Say("ROT1:ANGL 100\n");
      bench.Pass(milliseconds(500));
      EXPECT_TRUE(Moves(looker));
    }
    bench.Pass(milliseconds(500));
    EXPECT_EQ(Moves(looker), !armed);
  }
}

TEST_F(Missed, WhoeverTalksOrWaitsForAnAnswerIsThere) {
  VirtualBench bench(1.0);
  VirtualEsp mover(bench);
  VirtualScpi other(bench), looker(bench);
  mover.Ask("XW0.3;1PA100;TE?");
  other.Say("SYST:WATC 0.3\n");
  EXPECT_EQ(other.Ask("ROT1:SETT? 0.8"), "0") << "its answer comes after 0.8 s";
  EXPECT_TRUE(Moves(looker));
  for (int k = 0; k < 8; ++k) {
    bench.Pass(milliseconds(50));
    mover.Ask("1TP?");
  }
  EXPECT_TRUE(Moves(looker));
  mover.Say("XW0\n");
  other.Say("SYST:WATC 0\n");
  bench.Pass(milliseconds(500));
  EXPECT_TRUE(Moves(looker)) << "nobody is missed any more";
}

TEST_F(Missed, OneThatFallsSilentToo) {
  TcpClient mover(served_.at().esp_port);
  EXPECT_EQ(mover.Ask("XW0.3;1PA100;TE?"), "0");
  EXPECT_TRUE(Moves(looker_));
  EXPECT_TRUE(IsStopped(looker_));
}

TEST_F(Missed, ABenchFileArmsItWhereItIsServed) {
  for (const char* tables : {"scpi", "esp"}) {
    std::string text = hw::WithGuards(hw::WriteServedBenchFile(served_.at(), tables), "");
    text.resize(text.find("[clock]"));  // time runs
    auto bench = OpenHardware(hw::ParseBenchFile(text, "bench.toml", "."), RotaryScenario());
    bench->Bench().target.StartMove(100.0 * units::deg);
    EXPECT_TRUE(Moves(looker_)) << tables;
    bench.reset();  // as the system does when the program is killed
    EXPECT_TRUE(IsStopped(looker_)) << tables;
    looker_.Ask("SIM:REST;*OPC?");
  }
}

}  // namespace
}  // namespace twinbench::test
