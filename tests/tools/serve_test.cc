#include "tests/support/tcp_client.h"
#include "tests/tools/served_program.h"
#include "twin/core/run_record.h"

/// What only the rotary bench's server and measurement do; machine_serve_test.cc has what every bench's do.
namespace twinbench::test {
namespace {

using testing::HasSubstr, testing::Not;

class Served : public ServedProgram {
 protected:
  Served() : ServedProgram("rotary", ServedScenario("rotary")) {}

  /// A SCPI command to the server of bench.toml, by somebody who is none of our programs.
  void Say(const std::string& command) {
    const std::string file = Read("bench.toml"), before = "kind = \"scpi\"\naddress = \"tcp:127.0.0.1:";
    const auto at = file.find(before) + before.size();
    EXPECT_EQ(TcpClient(std::stoi(file.substr(at))).Ask(command + ";*OPC?"), "1");
  }
  /// Nothing was begun.
  void ExpectRehearsalStops(const std::vector<std::string>& options, const std::vector<std::string>& said) {
    ExpectEnded(Call(With(Measure("stopped"), options)), 1, said);
    EXPECT_FALSE(Exists("stopped"));
  }
};

TEST_F(Served, MeasuresTheReadingsThatRunMakesBitForBitKeepsTheRawCountsAndSaysWhoAnswered) {
  for (const char* tables : {"scpi", "esp"}) {
    const bool asks_token = std::string(tables) == "esp";
    const auto server = Serve({"--speed", "max", "--tables", tables, asks_token ? "--token" : "--no-token"});
    EXPECT_EQ(Read("bench.toml").find("token = ") != std::string::npos, asks_token);
    Succeed(Measure(tables));
    ExpectAsRun(tables);
    const auto record = RunRecord::Open(At(tables));
    EXPECT_EQ(record->RawBlocks().size(), record->Readings().size());
    EXPECT_THAT(record->provenance().source,
                testing::AllOf(HasSubstr("twinbench,rotary-bench"), HasSubstr("psd-adc16")));
    EXPECT_THAT(record->Events(),
                testing::Contains(testing::Field(&RecordedEvent::text, HasSubstr("62500 scans/s"))));
  }
}

// The procedure commands the correction: a server, which shows a controller, knows nothing of it.
TEST_F(Served, MeasuresWhatRunMakesWithACompensationAndTheCheckHolds) {
  std::string lines = kSmall;
  lines.replace(
      lines.find("[target.random]"), 15,
      "[target]\nharmonics = [{component = \"ez\", order = 1, amplitude_arcsec = 40.0, phase_deg = 70.0}]\n"
      "[target.random]");
  lines.replace(lines.find("ez_arcsec = 5.0\n"), 16, "");
  Write("small.toml", lines);
  Succeed({"run", "small.toml", "-o", "before"});
  Succeed({"compensate", "before", "-o", "table.csv"});
  // Other noise, as a second measurement has.
  const std::vector<std::string> again = {"--set", "seed=6", "--compensation", "target=table.csv"};
  MakeRun("run_again", again);
  EXPECT_NE(ReadingsOf("run_again"), ReadingsOf("before"));

  const auto server = Serve({"--speed", "max", "--set", "seed=6"});
  Succeed(With(Measure("measured"), again));
  EXPECT_EQ(ReadingsOf("measured"), ReadingsOf("run_again"));
  EXPECT_EQ(Read("measured/results.json"), Read("run_again/results.json"));

  const nlohmann::json check = Json({"compensate", "before", "--check", "measured", "--json", "-"})["check"];
  EXPECT_EQ(check, Json({"compensate", "before", "--check", "run_again", "--json", "-"})["check"]);
  EXPECT_TRUE(check["no_worse"]);
  EXPECT_GT(check["before_rms_arcsec"], 20.0);
  EXPECT_LT(check["remeasured_rms_arcsec"], 2.0);
  EXPECT_NEAR(check["ratio"], 1.0, 4.0 * double{check["u_ratio"]});

  ExpectRefused({"compensate", "before", "--check", "before"});
}

// Over IIOD and SCPI: a cause that the first run leaves open is told by the second, which has noise of its own.
TEST_F(Served, IsInvestigated) {
  Write("small.toml", kSmall);
  Write("hidden.toml",
        std::string(kSmall) + "[[effect]]\nname = \"psd_gain\"\nwhere = \"psd_a_x\"\ngain_error = 0.005\n");
  const auto server = Serve({"--speed", "max"}, "hidden.toml");
  Succeed({"investigate", "small.toml", "--bench", "bench.toml", "--budget", "3h", "-o", "inquiry"});
  const auto found = nlohmann::json::parse(Read("inquiry/investigation.json"));
  ASSERT_EQ(found.at("told"), "named") << found.dump(1);
  EXPECT_EQ(found.at("causes").at(0).at("name"), "psd_gain psd_a_x");
  const auto& size = found.at("causes").at(0).at("effects").at(0).at("parameters");
  EXPECT_NEAR(size.at("gain_error"), 0.005, 4.0 * double{size.at("u_gain_error")});
  ASSERT_GE(found.at("steps").size(), 2u) << found.dump(1);
  const auto& second = found.at("steps").at(1);
  std::vector<std::string> same = {"run", "hidden.toml", "-o", "same", "--set", "repeat=1"};
  for (const std::string set : second.at("sets")) same.insert(same.end(), {"--set", set});
  Succeed(same);
  EXPECT_EQ(ReadingsOf("inquiry/02-" + std::string(second.at("run"))), ReadingsOf("same"));
}

TEST_F(Served, EverySignalHoweverOftenStopsTheTablesAndTheRunCanBeResumed) {
  const auto server = Serve({"--speed", "2000"});
  for (const int signal : {SIGINT, SIGTERM, SIGQUIT, SIGHUP}) {
    Process run(At(""), Measure("stopped"));
    run.Await(2);
    for (int k = 0; k < 3; ++k) run.Signal(signal);
    ExpectEnded(run.Wait(), 1, {"tables were brought to rest. The controller says that all tables stand"});
  }
  Say("SIM:FAUL target,disconnect");  // waits for whoever opens the bench
  EXPECT_THAT(Call(Measure("stopped")).err, HasSubstr("(dropped); the bench is opened again"));
  EXPECT_EQ(ReadingsOf("stopped"), readings_);
}

TEST_F(Served, AControllerThatFreezesLeavesTheStateUnknown) {
  const auto server = Serve({"--speed", "2000"});
  WaitBriefly("0.1");
  Process run(At(""), Measure("frozen"));
  run.Await(3);
  server->Signal(SIGSTOP);
  run.Signal(SIGINT);
  const Outcome outcome = run.Wait();
  ExpectEnded(outcome, 3, {"STATE UNKNOWN - USE THE EMERGENCY STOP"});
  EXPECT_THAT(outcome.err, Not(HasSubstr("brought to rest")));
  server->Signal(SIGCONT);
  Succeed(Measure("frozen"));
  EXPECT_EQ(ReadingsOf("frozen"), readings_);
}

TEST_F(Served, ASecondOwnerIsRefusedAndTheFirstUndisturbed) {
  const auto server = Serve({"--speed", "2000"});
  Process first(At(""), Measure("first"), "first");
  first.Await(2);
  for (int k = 0; k < 3; ++k) {
    ExpectEnded(Call(Measure("second")), 1, {"driven by another program: measure into first (process "});
    EXPECT_FALSE(Exists("second"));
  }
  EXPECT_EQ(first.Wait().exit_code, 0);
  EXPECT_EQ(ReadingsOf("first"), readings_);
}

TEST_F(Served, IsReachedAtAnIpv6Address) {
  const auto server = Serve({"--speed", "max", "--bind", "::1"});
  EXPECT_THAT(Read("bench.toml"), HasSubstr("\"tcp:[::1]:"));
  Succeed(Measure("six"));
  EXPECT_EQ(ReadingsOf("six"), readings_);
}

TEST_F(Served, ABenchThatDoesNotAnswerIsNamed) {
  auto server = Serve();
  server->Signal(SIGTERM);
  EXPECT_EQ(server->Wait().exit_code, 0) << "asked to stop, it ends well";
  WaitBriefly("0.1");
  ExpectEnded(Call(Measure("none")), 1, {"127.0.0.1"});
  EXPECT_FALSE(Exists("none")) << "nothing was begun";
}

TEST_F(Served, ARehearsalComesBeforeAnyMotion) {
  Write("bench.toml", "kind = \"twin\"\n");
  const std::vector<std::string> only = {"measure", "small.toml", "--bench", "bench.toml", "--rehearse-only"};
  ExpectEnded(Call(only), 0, {"44 readings", "a word lost by the card might not show"});
  const std::vector<std::string> apart = {"--set", "amplifier.offset_mV=[-1500, -500, 500, 1500]"};
  EXPECT_THAT(Call(With(only, apart)).err, Not(HasSubstr("a word lost by the card")));
  ExpectRehearsalStops({"--rehearse", "--set", "psd_a.width_mm=0.2"}, {"PROBLEM"});
  const auto server = Serve();
  std::string text = Read("bench.toml");
  text.replace(text.find("axis = 1"), 8, "axis = 1\nlower_deg = -10.0\nupper_deg = 200.0");
  Write("bench.toml", text);
  ExpectRehearsalStops({"--rehearse"}, {"target would travel"});
}

TEST_F(Served, ARehearsalAsksTheControllersForTheirLimits) {
  const auto server = Serve();
  Say("ROT1:LIM:UPP 100");
  for (const char* how : {"--rehearse", "--rehearse-only"})
    ExpectRehearsalStops({how}, {" to 100 deg", "target would travel"});
}

TEST_F(Served, WithoutNoiseThereAreNoCountsAndATakenPortIsNamed) {
  ExpectRefused({"serve", "small.toml", "--set", "noise_free=true"});
  const auto server = Serve();
  const std::string told = Contents(At("") + "server.out");
  const std::size_t colon = told.find(':');
  const std::string port = told.substr(colon + 1, told.find('\n') - colon - 1);
  ExpectEnded(Call({"serve", "small.toml", "--iiod-port", port, "--scpi-port", "0", "--esp-port", "0"}), 1, {port});
}

}  // namespace
}  // namespace twinbench::test
