#include "tests/tools/program_here.h"

/// Every command answers to programs: one JSON document on stdout, whether it could do what it was asked or not.
namespace twinbench::test {
namespace {

using testing::HasSubstr;

struct Called {
  std::string command;
  std::vector<std::string> good, bad;  // arguments without --json
  std::vector<std::string> keys;       // of the good answer
};

constexpr const char* kStops = R"(bench = "encoder_comparison"
[encoder_procedure]
turns = 1
stops_per_turn = 12
passes = [1, -1]
)";

std::vector<Called> AllCalls() {
  return {
      {"run", {"s.toml", "-o", "new"}, {"bad.toml", "-o", "other"}, {"run", "bench", "seed", "readings", "separated", "results"}},
      {"campaign", {"study.toml", "-o", "t.sqlite"}, {"none.toml", "-o", "u.sqlite"}, {"trials", "lost", "results"}},
      {"measure", {"s.toml", "--bench", "bench.toml", "-o", "measured"}, {"s.toml", "--bench", "none.toml", "-o", "m"}, {"run", "results"}},
      {"serve", {}, {"bad.toml"}, {}},  // the good one does not end: AServedBench...
      {"export", {"made"}, {"none"}, {"run", "bench", "readings", "columns"}},
      {"import", {"readings.csv", "--scenario", "s.toml", "-o", "imported"}, {"bad.csv", "-o", "i"}, {"run", "results", "doubts"}},
      {"separate", {"made"}, {"bad.csv", "--scenario", "s.toml"}, {"device"}},
      {"compensate", {"turned"}, {"none"}, {"table"}},
      {"uncertainty", {"made"}, {"none"}, {"covariance"}},
      {"budget", {"small.toml", "--of", "separation"}, {"bad.toml"}, {"figures"}},
      {"plan", {"s.toml", "--cpu", "0.1"}, {"bad.toml"}, {"advice", "next"}},
      {"investigate", {"s.toml", "--twin", "s.toml", "--runs", "1", "--faint", "0", "-o", "inquiry"}, {"s.toml", "-o", "inquiry"}, {"steps"}},
      {"diagnose", {"made"}, {"bad.csv", "--scenario", "s.toml"}, {"verdict", "causes"}},
      {"report", {"made", "--svg", "pictures"}, {"none"}, {"source", "pictures"}},
      {"certificate", {"--template", "-o", "lab.toml"}, {"made", "-o", "c.xml"}, {"template"}},
      {"score", {"made"}, {"imported"}, {"values"}},
      {"new", {"rotary_4dof"}, {"rotary_4dog"}, {"bench", "scenario_toml"}},
      {"check", {"s.toml"}, {"bad.toml"}, {"bench", "readings"}},
      {"list", {}, {"--frob"}, {"benches"}},
      {"explain", {"eccentricity", "--bench", "encoder_comparison"}, {"eccentricitee"}, {"benches"}},
      {"help", {"effects"}, {"efects"}, {"topic", "text"}},
      {"schema", {}, {"--frob"}, {"oneOf"}},
      {"completion", {}, {"--frob"}, {"shell", "script"}},
  };
}

class JsonAnswers : public SmallProgram {
 protected:
  JsonAnswers() {
    BeginWith("json", [this] {
      Write("s.toml", kStops);
      Write("bad.toml", std::string(kStops) + "stop_per_turn = 3\n");
      Write("bad.csv", "these,are,no\nreadings\n");
      Write("study.toml", "scenario = \"s.toml\"\ntrials = 2\n");
      Write("bench.toml", "kind = \"twin\"\n");
      Succeed({"run", "s.toml", "-o", "made"});
      Succeed({"export", "made", "--readings", "readings.csv"});
    });
  }
  Outcome Answer(const std::string& command, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), command);
    arguments.push_back("--json");
    return Call(arguments);
  }
};

/// The commands of the program's own help.
std::set<std::string> CommandsOf(const std::string& completion) {
  const std::size_t begin = completion.find("-W \"") + 4, end = completion.find(" --help", begin);
  std::istringstream words(completion.substr(begin, end - begin));
  return {std::istream_iterator<std::string>(words), {}};
}

TEST_F(JsonAnswers, OfEveryCommandAreOneDocument) {
  Succeed({"run", TWINBENCH_SOURCE_DIR "/scenarios/turntable_shifts.toml", "-o", "turned"});
  std::set<std::string> called;
  for (const Called& call : AllCalls()) {
    called.insert(call.command);
    if (call.command == "serve") continue;
    const Outcome outcome = Answer(call.command, call.good);
    EXPECT_EQ(outcome.exit_code, 0) << call.command << ": " << outcome.err;
    const nlohmann::json json = nlohmann::json::parse(outcome.out, nullptr, false);
    ASSERT_TRUE(json.is_object()) << call.command << ": " << outcome.out.substr(0, 200);
    for (const std::string& key : call.keys) EXPECT_TRUE(json.contains(key)) << call.command << " has no " << key << ": " << outcome.out.substr(0, 300);
  }
  EXPECT_EQ(called, CommandsOf(Succeed({"completion"})));
}

TEST_F(JsonAnswers, OfAFailureSayWhatStderrSaysAndLeaveTheExitCode) {
  for (const Called& call : AllCalls()) {
    std::vector<std::string> plain = call.bad;
    plain.insert(plain.begin(), call.command);
    const Outcome said = Call(plain), outcome = Answer(call.command, call.bad);
    EXPECT_EQ(outcome.exit_code, 2) << call.command;
    EXPECT_EQ(outcome.err, said.err) << call.command;
    const nlohmann::json json = nlohmann::json::parse(outcome.out, nullptr, false);
    ASSERT_TRUE(json.is_object() && json.contains("error")) << call.command << ": " << outcome.out;
    EXPECT_EQ(json.at("error").at("exit_code"), 2);
    EXPECT_THAT(outcome.err, HasSubstr(json.at("error").at("message").get<std::string>())) << call.command;
  }
}

TEST_F(JsonAnswers, OfABadInputNameFileLineAndKey) {
  const auto fault = [&](const std::string& command, const std::vector<std::string>& arguments) {
    return nlohmann::json::parse(Answer(command, arguments).out).at("error");
  };
  const nlohmann::json key = fault("check", {"bad.toml"});
  EXPECT_EQ(key.at("kind"), "input");
  EXPECT_EQ(key.at("file"), "bad.toml");
  EXPECT_EQ(key.at("line"), 6);
  EXPECT_EQ(key.at("key"), "encoder_procedure.stop_per_turn");
  EXPECT_THAT(key.at("expected").get<std::string>(), HasSubstr("stops_per_turn"));
  EXPECT_EQ(fault("check", {"s.toml", "--set", "encoder_procedure.turns=0"}).at("key"), "encoder_procedure.turns");
  Write("seed.toml", "bench = \"encoder_comparison\"\nseed = \"many\"\n");
  EXPECT_EQ(fault("check", {"seed.toml"}).at("key"), "seed");
  EXPECT_FALSE(fault("check", {"none.toml"}).contains("key"));
  EXPECT_EQ(fault("check", {"not: 3: there.toml"}).at("file"), "not: 3: there.toml");
  EXPECT_EQ(fault("run", {"s.toml", "-o", "x", "--seed", "-1"}).at("key"), "--seed");
  EXPECT_EQ(fault("separate", {"bad.csv", "--scenario", "s.toml"}).at("line"), 2);
  EXPECT_EQ(fault("run", {"s.toml"}).at("kind"), "command_line");
}

TEST_F(JsonAnswers, GoIntoAFileThatIsNamedAndNeverIntoAnInput) {
  EXPECT_THAT(Succeed({"check", "s.toml", "--json", "c.json"}), HasSubstr("fine"));
  EXPECT_EQ(nlohmann::json::parse(Read("c.json")).at("readings"), 24);
  EXPECT_EQ(Call({"run", "s.toml", "-o", "x", "--json", "s.toml"}).exit_code, 2);
  EXPECT_EQ(Read("s.toml"), kStops);
  EXPECT_FALSE(Exists("x"));
}

TEST_F(JsonAnswers, OfAnExportAreTheNumbersOfReadingsCsv) {
  const nlohmann::json columns = nlohmann::json::parse(Answer("export", {"made"}).out).at("columns");
  std::istringstream csv(Read("readings.csv"));
  std::string header, first;
  std::getline(csv, header);
  std::getline(csv, first);
  ASSERT_TRUE(header.starts_with("reading,"));
  EXPECT_EQ(columns.at("reading").size(), 24u);
  std::istringstream names(header), cells(first);
  for (std::string name, cell; std::getline(names, name, ',') && std::getline(cells, cell, ',');)
    if (const nlohmann::json& value = columns.at(name).at(0); value.is_number()) {
      EXPECT_EQ(value.get<double>(), std::stod(cell)) << name;
    }
}

TEST_F(JsonAnswers, OfWhatWasOnlyLookedAtSayWhatWasSeen) {
  for (const char* scenario : {"s.toml", "small.toml"}) {
    const nlohmann::json rehearsal = nlohmann::json::parse(Answer("measure", {scenario, "--bench", "bench.toml", "--rehearse-only"}).out).at("rehearsal");
    EXPECT_GT(rehearsal.at("readings"), 0) << scenario;
    EXPECT_TRUE(rehearsal.at("problems").empty()) << scenario;
  }
  EXPECT_THAT(nlohmann::json::parse(Answer("import", {"readings.csv", "--look"}).out).at("look").get<std::string>(), HasSubstr("reference_deg"));
  EXPECT_THAT(nlohmann::json::parse(Answer("campaign", {"study.toml", "--trial", "1"}).out).at("scenario_toml").get<std::string>(),
              HasSubstr("bench = \"encoder_comparison\""));
}

TEST_F(JsonAnswers, OfAServedBenchComeAsSoonAsItCanBeReached) {
  Process server(At(""), {"serve", "s.toml", "--scpi-port", "0", "--esp-port", "0", "--no-pty", "--write-bench", "served.toml", "--token", "--json"}, "s");
  while (server.Runs() && Contents(At("") + "s.out").find("}\n") == std::string::npos) usleep(10000);
  server.Signal(SIGINT);
  const Outcome outcome = server.Wait();
  const nlohmann::json at = nlohmann::json::parse(outcome.out);
  EXPECT_GT(at.at("scpi_port").get<int>(), 0);
  EXPECT_THAT(Read("served.toml"), HasSubstr(at.at("token").get<std::string>()));
  EXPECT_THAT(outcome.err, HasSubstr("scpi " + at.at("host").get<std::string>()));
}

}  // namespace
}  // namespace twinbench::test
