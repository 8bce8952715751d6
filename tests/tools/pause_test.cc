#include "tools/twinbench/pause.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "twin/core/errors.h"

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

TEST(Pause, HoldsNobodyUnasked) {
  Held run;
  run.pause.HoldIfAsked(3, [] { return Standstill{true, ""}; }, NoStop);
  EXPECT_TRUE(run.said.empty());
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

TEST(Pause, IsNoneWhileAnythingMovesOrNobodyAnswers) {
  Held run;
  run.pause.Ask(true);
  run.pause.HoldIfAsked(3, [] { return Standstill{false, "target moves"}; }, NoStop);
  EXPECT_EQ(run.said, (std::vector<std::string>{"not yet: target moves"}));
  Held mute;
  mute.pause.Ask(true);
  mute.pause.HoldIfAsked(3, []() -> Standstill { throw BenchError("no answer"); }, NoStop);
  EXPECT_EQ(mute.said, (std::vector<std::string>{"not yet: no answer"}));
}

TEST(Pause, LooksOnAndSaysWhatMoves) {
  Held run;
  run.pause.Ask(true);
  int looks = 0;
  run.pause.HoldIfAsked(3, [&] { return ++looks == 1 ? Standstill{true, ""} : Standstill{false, "x moves"}; }, NoStop);
  EXPECT_EQ(run.said, (std::vector<std::string>{"paused 3", "restless: x moves", "over 3"}));
}

TEST(Pause, EndsAtAStop) {
  Held run;
  run.pause.Ask(true);
  int asked = 0;
  run.pause.HoldIfAsked(3, {}, [&] { return ++asked > 2; });
  EXPECT_EQ(run.said.back(), "over 3");
}

}  // namespace
}  // namespace twinbench::tools
