#include "twin/procedure/watch.h"

#include "tests/procedure/troubled_run.h"
#include "tests/support/kept_text.h"

/// What is noticed while tables move, with tables that lie, and how a real bench is brought back.
namespace twinbench::procedure {
namespace {

/// A table whose controller says whatever the test wants.
struct ScriptedTable : RotaryTable {
  void StartMove(double angle_rad) override {
    moves_deg.push_back(angle_rad / units::deg);
    if (obeys) state.encoder_rad = angle_rad;
  }
  bool Settles(Duration) override {
    ++seconds;
    if (while_moving) while_moving(*this);
    return seconds >= settles_after_s;
  }
  TableState State() override {
    if (while_looked_at) while_looked_at(*this);
    return state;
  }
  void Stop() override {
    ++stops;
    if (obeys) state.moving = false;
  }
  void Home() override {
    ++homes;
    state.referenced = true;
  }

  ScriptedTable() { state.encoder_rad = 0.0; }

  TableState state;
  std::function<void(ScriptedTable&)> while_moving, while_looked_at;
  std::vector<double> moves_deg;
  bool obeys = true;
  int seconds = 0, settles_after_s = 0, stops = 0, homes = 0;
};

/// Two such tables on the twin's other devices; a real bench, for it has no simulation.
struct ScriptedBench {
  RotaryBench Bench() {
    const RotaryBench rest = twin.Bench();
    return {rest.clock,          target,           reference,       rest.adc,
            rest.autocollimator, rest.thermometer, rest.goniometer, fixture};
  }
  struct Hand : Fixture {
    void Mount(int setup, double, double) override { setups.push_back(setup); }
    std::vector<int> setups;
  };

  sim::Twin twin{test::RotaryScenario()};
  ScriptedTable target, reference;
  Hand fixture;
};

std::string FaultOf(ScriptedBench& scripted, double to_deg, const Options& options = {}) {
  RotaryBench bench = scripted.Bench();
  return FaultIn([&] { MoveBoth(bench, to_deg * units::deg, -to_deg * units::deg, options); });
}

/// Both tables are sent to +-10 deg.
struct WatchedMove {
  const char* name;
  std::function<void(ScriptedBench&, Options&)> is_so;
  const char* fault;
  bool begins = true;                         // else nothing moves, not even the other table
  std::pair<int, int> within_s = {0, 1'000};  // what the slower table takes at least and at most
};

class Watch : public testing::TestWithParam<WatchedMove> {};

TEST_P(Watch, OfAMove) {
  ScriptedBench bench;
  Options options;
  GetParam().is_so(bench, options);
  EXPECT_EQ(FaultOf(bench, 10.0, options), GetParam().fault);
  EXPECT_EQ(bench.target.moves_deg, GetParam().begins ? std::vector{10.0} : std::vector<double>{});
  const int seconds = std::max(bench.target.seconds, bench.reference.seconds);
  EXPECT_GE(seconds, GetParam().within_s.first);
  EXPECT_LE(seconds, GetParam().within_s.second);
}

const WatchedMove kMoves[] = {
    {"LetsPassWhatArrives", [](ScriptedBench& b, Options&) { b.target.settles_after_s = 3; }, "none"},
    {"RefusesWhatLiesBeyondTheSoftLimitsBeforeAnythingMoves",
     [](ScriptedBench&, Options& o) { o.reference.lower_rad = -5.0 * units::deg; }, "limit of reference", false},
    {"NeverTrustsATableThatLostItsOrigin",
     [](ScriptedBench& b, Options&) { b.reference.state.referenced = false; }, "restarted of reference", false},
    {"NoticesALimitSwitchThatIsHitOnTheWay",
     [](ScriptedBench& b, Options&) {
       b.target.settles_after_s = 100;
       b.target.while_moving = [](ScriptedTable& table) { table.state.limit = -1; };
     },
     "limit of target"},
    {"NoticesATableThatStandsStill",
     [](ScriptedBench& b, Options& o) {
       b.reference.obeys = false;
       b.reference.settles_after_s = 100;
       o.reference.stall_s = 4.0;
     },
     "stalled of reference", true, {0, 5}},
    {"TellsATableThatNeverSettlesFromOneThatStandsStillOnItsWay",
     [](ScriptedBench& b, Options& o) {
       b.target.settles_after_s = 1000;  // there at once, but the controller never says so
       o.target.in_position_rad = 1.0 * units::arcsec;
     },
     "not_in_position of target", true, {0, 6}},
    {"NoticesATableThatGoesTheWrongWay",
     [](ScriptedBench& b, Options& o) {
       b.target.obeys = false;
       b.target.settles_after_s = 100;
       b.target.while_moving = [](ScriptedTable& table) { table.state.encoder_rad -= 1.0 * units::deg; };
       o.target.following_rad = 2.5 * units::deg;
     },
     "following of target", true, {3, 3}},
    {"GivesUpOnWhatTakesTooLong",
     [](ScriptedBench& b, Options& o) {
       b.target.settles_after_s = 1000;
       b.target.while_moving = [](ScriptedTable& table) { table.state.encoder_rad += 1e-6; };
       o.target.move_timeout_s = 30.0;
     },
     "not_in_position of target", true, {0, 32}}};
INSTANTIATE_TEST_SUITE_P(Moves, Watch, testing::ValuesIn(kMoves), [](const auto& test) { return test.param.name; });

TEST(WatchedMove, OnALimitSwitchOnlyTheWayBackIsOpen) {
  ScriptedBench bench;
  bench.target.state.limit = 1;
  EXPECT_EQ(FaultOf(bench, 10.0), "limit of target");
  EXPECT_TRUE(bench.target.moves_deg.empty());
  EXPECT_EQ(FaultOf(bench, -10.0), "none");
}

TEST(WatchedMove, TakesNoMoveForDoneThatEndsOnALimitSwitch) {
  for (const double to_deg : {0.0, 10.0, -10.0}) {  // without a way, the switch closes as it begins
    ScriptedBench bench;
    bench.target.while_moving = [&](ScriptedTable& table) { table.state.limit = to_deg < 0.0 ? -1 : 1; };
    Options options;
    options.target.in_position_rad = 1.0 * units::arcsec;
    EXPECT_EQ(FaultOf(bench, to_deg, options), "limit of target") << to_deg;
    EXPECT_EQ(FaultOf(bench, to_deg), "limit of target") << to_deg << ", without a tolerance";
  }
}

TEST(WatchedMove, NoticesAStepThatWasLost) {
  ScriptedBench bench;
  bench.target.while_moving = [](ScriptedTable& table) { table.state.encoder_rad -= 2.0 * units::arcsec; };
  Options options;
  EXPECT_EQ(FaultOf(bench, 10.0, options), "none") << "no tolerance was given";
  options.target.in_position_rad = 1.0 * units::arcsec;
  EXPECT_EQ(FaultOf(bench, 20.0, options), "not_in_position of target");
}

Scenario TwoSetups() {
  return Altered(test::RotaryScenario(), {"procedure.phases=[\"full_circle\"]", "procedure.positions=36", "procedure.shifts=[0, 1]",
                                          "procedure.passes=[-1]", "procedure.run_up_steps=0.5"});
}

/// Its moves when only the A/D of this bench fails, once, at the reading with this number.
std::vector<double> MovesAfterAFault(ScriptedBench& scripted, std::size_t reading, test::MemoryLog& log) {
  std::optional<std::size_t> moves_before;
  const auto fails_once = [&](const std::string& device, const std::string&) {
    if (device != "adc" || log.readings.size() != reading || moves_before) return false;
    scripted.target.state.encoder_rad += 3.0 * units::arcsec;  // it was pushed meanwhile
    moves_before = scripted.target.moves_deg.size();
    return true;
  };
  Course course{.before = FailsIf(fails_once, FaultKind::kDropped)};
  course.options.target.in_position_rad = course.options.reference.in_position_rad = 1.0 * units::arcsec;
  EXPECT_EQ(EndOn(scripted.Bench(), TwoSetups(), log, course), "none");
  return {scripted.target.moves_deg.begin() + static_cast<long>(moves_before.value()), scripted.target.moves_deg.end()};
}

/// Done once, when five readings are kept and this device is asked; by default any.
test::TroubledBench::Trouble OnceAfterFive(const test::MemoryLog& log, const std::function<void()>& happens,
                                           const std::string& asked = "") {
  return [=, &log, is_done = false](const std::string& device, const std::string&, CallAnswer&) mutable {
    if (is_done || log.readings.size() != 5 || (!asked.empty() && device != asked)) return;
    is_done = true;
    happens();
  };
}

Standstill AfterTheStop(ScriptedBench& scripted, const Options& options = {}) {
  RotaryBench bench = scripted.Bench();
  return StopBoth(bench, options);
}

/// What counts as rest is asked in rest_test.cc.
TEST(StopBoth, TellsBothAndHoldsEachToItsOwnLimit) {
  ScriptedBench bench;
  bench.target.while_looked_at = [](ScriptedTable& table) { table.state.encoder_rad += 8.0 * units::arcsec; };
  Options options;
  options.target.in_position_rad = 20.0 * units::arcsec;
  options.reference.in_position_rad = 1.0 * units::arcsec;
  EXPECT_TRUE(AfterTheStop(bench, options).is_sure) << "it may be 20 arcsec off";
  EXPECT_EQ(std::pair(bench.target.stops, bench.reference.stops), std::pair(1, 1));
  std::swap(bench.target.while_looked_at, bench.reference.while_looked_at);
  const Standstill stands = AfterTheStop(bench, options);
  EXPECT_FALSE(stands.is_sure);
  EXPECT_THAT(stands.why_not, testing::HasSubstr("reference"));
}

TEST(RealBench, IsBroughtBackToTheLastStopFromTheSideItWasApproachedFrom) {
  ScriptedBench scripted;
  test::MemoryLog log;
  const std::vector<double> moves = MovesAfterAFault(scripted, 3, log);
  // Pass -1 comes down from 350 deg: stops at 350, 340, 330 were kept, 320 failed.
  ASSERT_GE(moves.size(), 3u);
  EXPECT_DOUBLE_EQ(moves[0], 335.0);
  EXPECT_DOUBLE_EQ(moves[1], 330.0);
  EXPECT_DOUBLE_EQ(moves[2], 320.0);
  EXPECT_EQ(log.readings.size(), 72u);
  EXPECT_EQ(log.attempts.size(), 1u);
}

TEST(RealBench, IsNotMountedAgainWhenAFaultComesAfterTheMounting) {
  ScriptedBench scripted;
  test::MemoryLog log;
  MovesAfterAFault(scripted, 36, log);  // the first reading of set-up 1
  EXPECT_EQ(scripted.fixture.setups, (std::vector<int>{0, 1}));
  EXPECT_EQ(log.readings.size(), 72u);
}

TEST(RealBench, WaitsForNoMountingThatAPersonSaysIsDone) {
  Scenario scenario = TwoSetups();
  RotaryOf(scenario).procedure.remount_s = 1000.0;
  for (const bool by_hand : {false, true}) {
    ScriptedBench scripted;
    test::MemoryLog log;
    Course course;
    course.options.hand_ends_mounting = by_hand;
    EXPECT_EQ(EndOn(scripted.Bench(), scenario, log, course), "none");
    const double took_s = ToSeconds(log.readings.back().time.time_since_epoch());
    EXPECT_EQ(took_s > 2000.0, !by_hand) << "twice remount_s, or none";
    EXPECT_EQ(took_s < 1000.0, by_hand) << took_s;
    const bool is_said = log.events[0].text.find(kMountedByHand) != std::string::npos;
    EXPECT_EQ(is_said, by_hand) << log.events[0].text;
  }
}

TEST(RealBench, KeepsNoReadingAboutWhichATableHadLostItsOrigin) {
  for (const char* asked_last : {"thermometer", "adc"}) {  // before the look before the block, and the one behind it
    ScriptedBench scripted;
    test::MemoryLog log;
    const auto restarts = [&] {
      scripted.reference.state.referenced = false;
      scripted.reference.state.encoder_rad = kNaN;
    };
    EXPECT_EQ(EndOn(scripted.Bench(), TwoSetups(), log, {.before = OnceAfterFive(log, restarts, asked_last)}), "none");
    EXPECT_EQ(scripted.reference.homes, 1) << asked_last;
    ASSERT_EQ(log.attempts.size(), 1u);
    EXPECT_EQ(log.attempts[0].fault, "restarted");
    EXPECT_EQ(log.attempts[0].reading, 5);
    for (const Reading& reading : log.readings) EXPECT_EQ(reading.extra.size(), 4u) << "two tables, before and behind";
  }
}

TEST(RealBench, FindsNoOriginThatNobodyAllowedItToLookFor) {
  ScriptedBench scripted;
  test::MemoryLog log;
  Course course;
  course.before = [&](const std::string&, const std::string&, CallAnswer&) {
    if (log.readings.size() != 5) return;
    scripted.target.state.referenced = false;
    scripted.target.state.encoder_rad = 0.0;
  };
  course.options.may_home = false;
  EXPECT_EQ(EndOn(scripted.Bench(), TwoSetups(), log, course), "refused of target");
  EXPECT_KEPT(log.attempts.back().text);
  EXPECT_EQ(scripted.target.homes, 0);
  EXPECT_EQ(log.readings.size(), 5u);
}

}  // namespace
}  // namespace twinbench::procedure
