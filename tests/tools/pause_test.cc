#include "tools/twinbench/alarm_text.h"
#include "tools/twinbench/live_judge.h"
#include "tools/twinbench/passing_run.h"
#include "tools/twinbench/pause.h"
#include "tools/twinbench/terminal.h"
#include "twin/benches/registry.h"

/// A run that is held between two readings.
namespace twinbench::tools {
namespace {

using procedure::Standstill;

struct Held {
  std::vector<std::string> said;
  Pause pause{{[this](int reading) { said.push_back("paused " + std::to_string(reading)); },
               [this](const std::string& why) { said.push_back("not yet: " + why); },
               [this](const std::string& why) {
                 said.push_back("restless: " + why);
                 pause.Ask(false);
               },
               [this](int reading) { said.push_back("over " + std::to_string(reading)); }}};
};

bool NoStop() {
  return false;
}

using Words = std::vector<std::string>;

/// What is said where a run may be held at its third reading.
Words SaidAt(bool is_asked, const std::function<Standstill()>& look, const std::function<bool()>& stop = NoStop) {
  Held run;
  run.pause.Ask(is_asked);
  run.pause.HoldIfAsked(3, look, stop);
  return run.said;
}

TEST(Pause, HoldsWhoAsksUntilAStopUnlessAnythingMovesOrNobodyAnswersAndLooksOn) {
  const auto moves = [] { return Standstill{false, "x moves"}; };
  int looks = 0, asked = 0;
  EXPECT_EQ(SaidAt(false, [] { return Standstill{true, ""}; }), Words{});
  EXPECT_EQ(SaidAt(true, moves), Words{"not yet: x moves"});
  EXPECT_EQ(SaidAt(true, []() -> Standstill { throw BenchError("no answer"); }), Words{"not yet: no answer"});
  EXPECT_EQ(SaidAt(true, [&] { return ++looks == 1 ? Standstill{true, ""} : moves(); }),
            (Words{"paused 3", "restless: x moves", "over 3"}));
  EXPECT_EQ(SaidAt(true, {}, [&] { return ++asked > 2; }).back(), "over 3");
}

TEST(Pause, HoldsUntilItIsOver) {
  Held run;
  run.pause.Ask(true);
  std::jthread other([&run] {
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    run.pause.Ask(false);
  });
  const auto begun = std::chrono::steady_clock::now();
  run.pause.HoldIfAsked(3, {}, NoStop);
  EXPECT_GE(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(50));
  EXPECT_EQ(run.said, (std::vector<std::string>{"paused 3", "over 3"}));
}

TEST(ForTerminal, LeavesNothingThatATerminalObeys) {
  EXPECT_EQ(ForTerminal("\033]0;title\007\033[2J"), "?]0;title??[2J");
  EXPECT_EQ(ForTerminal("a\xC2\x9B" "31mb\r\x7F"), "a?31mb??");
  EXPECT_EQ(ForTerminal("line\n\tµm ± °"), "line\n\tµm ± °");
}

// What a page is told of readings while they come, against what the whole run says.

struct Told {
  std::vector<int> predicted;  // numbers of readings
  nlohmann::json last;         // residual
  std::vector<std::string> alarms;
  std::string unjudged;
};

/// Hands the readings over in two parts and listens.
Told Judged(const Scenario& scenario, const std::vector<Reading>& readings) {
  Told told;
  const auto listen = [&told](const char* kind, const std::string& text) {
    const nlohmann::json json = nlohmann::json::parse(text);
    if (kind == std::string("alarm")) told.alarms.push_back(json.at("words"));
    if (kind == std::string("unjudged")) told.unjudged = json.at("why");
    if (kind != std::string("residuals")) return;
    for (const nlohmann::json& reading : json.at("readings")) told.predicted.push_back(reading.at("n"));
    told.last = json.at("readings").back();
  };
  LiveJudge judge(scenario, listen);
  for (std::size_t k = 0; k < readings.size(); ++k) {
    if (k == readings.size() / 2) std::this_thread::sleep_for(std::chrono::milliseconds(300));
    judge.Hear(readings[k]);
  }
  return told;
}

Scenario Small() {
  return ParseScenario(R"(bench = "rotary_4dof"
[procedure]
phases = ["full_circle"]
positions = 12
shifts = [0, 1, 5]
[mechanics]
fidelity = "kinematic"
)",
                       "small.toml", "");
}

TEST(LiveJudge, SaysOfEveryReadingWhatTheWholeRunSays) {
  const Scenario scenario = Small();
  std::vector<Reading> readings = ReadingsOfTwin(scenario);
  const std::size_t disturbed = readings.size() * 3 / 4;
  readings[disturbed].mean_V[0] += 0.05;
  const Told told = Judged(scenario, readings);

  const diagnose::LinearRun run = BenchOf(scenario).linear_run(readings, scenario, Estimator::kRigorous);
  const Watched whole = Seen(run, {0.01, BenchOf(scenario).planned_readings(scenario)});
  ASSERT_EQ(told.predicted.size(), whole.report.predicted.size());
  for (std::size_t k = 0; k < told.predicted.size(); ++k) EXPECT_EQ(told.predicted[k], whole.report.predicted[k].reading);
  const diagnose::PredictedReading& last = whole.report.predicted.back();
  EXPECT_NEAR(told.last.at("v")[0], last.deviation[0] / whole.units[0].to_SI, 1e-6 * last.u[0] / whole.units[0].to_SI);
  ASSERT_EQ(told.alarms.size(), whole.report.alarms.size());
  ASSERT_FALSE(told.alarms.empty());
  EXPECT_EQ(told.alarms[0], AlarmText(whole.report.alarms[0], whole));
  EXPECT_EQ(whole.report.alarms[0].reading, readings[disturbed].reading);
}

TEST(LiveJudge, WaitsForEnoughReadings) {
  const Scenario scenario = Small();
  const std::vector<Reading> readings = ReadingsOfTwin(scenario);
  const Told told = Judged(scenario, {readings.begin(), readings.begin() + 2});
  EXPECT_EQ(told.unjudged, "");
  EXPECT_TRUE(told.alarms.empty());
}

}  // namespace
}  // namespace twinbench::tools
