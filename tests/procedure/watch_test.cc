#include "twin/procedure/watch.h"

#include <gtest/gtest.h>

#include "tests/support/memory_log.h"
#include "tests/support/rotary_scenario.h"
#include "tests/support/troubled_bench.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/device_fault.h"

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
  try {
    MoveBoth(bench, to_deg * units::deg, -to_deg * units::deg, options);
  } catch (const DeviceFault& fault) {
    return std::string(FaultName(fault.kind())) + " of " + fault.device();
  }
  return "none";
}

TEST(Watch, LetsAMoveThatArrivesPass) {
  ScriptedBench bench;
  bench.target.settles_after_s = 3;
  EXPECT_EQ(FaultOf(bench, 10.0), "none");
  EXPECT_EQ(bench.target.moves_deg, std::vector<double>{10.0});
}

TEST(Watch, RefusesAMoveBeyondTheSoftLimitsBeforeAnythingMoves) {
  ScriptedBench bench;
  Options options;
  options.reference.lower_rad = -5.0 * units::deg;
  EXPECT_EQ(FaultOf(bench, 10.0, options), "limit of reference");
  EXPECT_TRUE(bench.target.moves_deg.empty()) << "not even the other table";
}

TEST(Watch, OnALimitSwitchOnlyTheWayBackIsOpen) {
  ScriptedBench bench;
  bench.target.state.limit = 1;
  EXPECT_EQ(FaultOf(bench, 10.0), "limit of target");
  EXPECT_TRUE(bench.target.moves_deg.empty());
  EXPECT_EQ(FaultOf(bench, -10.0), "none");
}

TEST(Watch, TakesNoMoveForDoneThatEndsOnALimitSwitch) {
  for (const double to_deg : {0.0, 10.0, -10.0}) {  // without a way, the switch closes as it begins
    ScriptedBench bench;
    bench.target.while_moving = [&](ScriptedTable& table) { table.state.limit = to_deg < 0.0 ? -1 : 1; };
    Options options;
    options.target.in_position_rad = 1.0 * units::arcsec;
    EXPECT_EQ(FaultOf(bench, to_deg, options), "limit of target") << to_deg;
    EXPECT_EQ(FaultOf(bench, to_deg), "limit of target") << to_deg << ", without a tolerance";
  }
}

TEST(Watch, NoticesALimitSwitchThatIsHitOnTheWay) {
  ScriptedBench bench;
  bench.target.settles_after_s = 100;
  bench.target.while_moving = [](ScriptedTable& table) { table.state.limit = -1; };
  EXPECT_EQ(FaultOf(bench, 10.0), "limit of target");
}

TEST(Watch, NoticesATableThatStandsStill) {
  ScriptedBench bench;
  bench.reference.obeys = false;
  bench.reference.settles_after_s = 100;
  Options options;
  options.reference.stall_s = 4.0;
  EXPECT_EQ(FaultOf(bench, 10.0, options), "stalled of reference");
  EXPECT_LE(bench.reference.seconds, 5);
}

TEST(Watch, TellsATableThatNeverSettlesFromOneThatStandsStillOnItsWay) {
  ScriptedBench bench;
  bench.target.settles_after_s = 1000;  // there at once, but the controller never says so
  Options options;
  options.target.in_position_rad = 1.0 * units::arcsec;
  EXPECT_EQ(FaultOf(bench, 10.0, options), "not_in_position of target");
  EXPECT_LE(bench.target.seconds, 6);
}

TEST(Watch, NoticesATableThatGoesTheWrongWay) {
  ScriptedBench bench;
  bench.target.obeys = false;
  bench.target.settles_after_s = 100;
  bench.target.while_moving = [](ScriptedTable& table) { table.state.encoder_rad -= 1.0 * units::deg; };
  Options options;
  options.target.following_rad = 2.5 * units::deg;
  EXPECT_EQ(FaultOf(bench, 10.0, options), "following of target");
  EXPECT_EQ(bench.target.seconds, 3);
}

TEST(Watch, NoticesAStepThatWasLost) {
  ScriptedBench bench;
  bench.target.while_moving = [](ScriptedTable& table) { table.state.encoder_rad -= 2.0 * units::arcsec; };
  Options options;
  EXPECT_EQ(FaultOf(bench, 10.0, options), "none") << "no tolerance was given";
  options.target.in_position_rad = 1.0 * units::arcsec;
  EXPECT_EQ(FaultOf(bench, 20.0, options), "not_in_position of target");
}

TEST(Watch, GivesUpOnAMoveThatTakesTooLong) {
  ScriptedBench bench;
  bench.target.settles_after_s = 1000;
  bench.target.while_moving = [](ScriptedTable& table) { table.state.encoder_rad += 1e-6; };
  Options options;
  options.target.move_timeout_s = 30.0;
  EXPECT_EQ(FaultOf(bench, 10.0, options), "not_in_position of target");
  EXPECT_LE(bench.target.seconds, 32);
}

TEST(Watch, NeverTrustsATableThatLostItsOrigin) {
  ScriptedBench bench;
  bench.reference.state.referenced = false;
  EXPECT_EQ(FaultOf(bench, 10.0), "restarted of reference");
  EXPECT_TRUE(bench.target.moves_deg.empty());
}

Scenario TwoSetups() {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).procedure.phases = {"full_circle"};
  RotaryOf(scenario).procedure.positions = 36;
  RotaryOf(scenario).procedure.shifts = {0, 1};
  RotaryOf(scenario).procedure.passes = {-1};
  RotaryOf(scenario).procedure.run_up_steps = 0.5;
  return scenario;
}

/// Only the A/D of this bench fails, once, at the reading with this number.
std::vector<double> MovesAfterAFault(ScriptedBench& scripted, const Scenario& scenario, std::size_t reading,
                                     test::MemoryLog& log) {
  RotaryBench real = scripted.Bench();
  std::vector<double> moves_after;
  bool failed = false;
  test::TroubledBench troubled(real, [&](const std::string& device, const std::string&, CallAnswer&) {
    if (device != "adc" || log.readings.size() != reading || failed) return;
    failed = true;
    scripted.target.state.encoder_rad += 3.0 * units::arcsec;  // it was pushed meanwhile
    moves_after.push_back(static_cast<double>(scripted.target.moves_deg.size()));
    throw DeviceFault(FaultKind::kDropped, "adc", "connection lost");
  });
  RotaryBench bench = troubled.Bench();
  Options options;
  options.log = &log;
  options.target.in_position_rad = options.reference.in_position_rad = 1.0 * units::arcsec;
  CarryOut(bench, scenario, log, {}, options);
  const auto first = static_cast<long>(moves_after.at(0));
  return {scripted.target.moves_deg.begin() + first, scripted.target.moves_deg.end()};
}

Standstill AfterTheStop(ScriptedBench& scripted) {
  RotaryBench bench = scripted.Bench();
  return StopBoth(bench);
}

TEST(StopBoth, IsSureOfTablesThatSayThatTheyStandAndDo) {
  ScriptedBench bench;
  bench.target.state.moving = bench.reference.state.moving = true;
  const Standstill stands = AfterTheStop(bench);
  EXPECT_TRUE(stands.is_sure) << stands.why_not;
  EXPECT_EQ(bench.target.stops, 1);
  EXPECT_EQ(bench.reference.stops, 1);
}

TEST(StopBoth, IsNotSureOfAFrozenControllerThatStillSaysMoving) {
  ScriptedBench bench;
  bench.reference.state.moving = true;
  bench.reference.obeys = false;
  const Standstill stands = AfterTheStop(bench);
  EXPECT_FALSE(stands.is_sure);
  EXPECT_EQ(stands.why_not, "reference still moves after the stop, at 0.000000 deg");
}

TEST(StopBoth, BelievesTheEncoderMoreThanTheControllersWord) {
  ScriptedBench bench;
  bench.target.while_looked_at = [](ScriptedTable& table) { table.state.encoder_rad += 1e-3; };
  EXPECT_FALSE(AfterTheStop(bench).is_sure);
}

TEST(StopBoth, WaitsForATableThatTakesTimeToComeToRest) {
  ScriptedBench bench;
  int looks = 0;
  bench.target.while_looked_at = [&looks](ScriptedTable& table) {
    table.state.encoder_rad += ++looks < 5 ? 1e-3 : 0.0;
  };
  EXPECT_TRUE(AfterTheStop(bench).is_sure);
}

TEST(StopBoth, OneThatDoesNotAnswerKeepsNobodyFromStoppingTheOther) {
  ScriptedBench bench;
  bench.target.while_looked_at = [](ScriptedTable&) { throw DeviceFault(FaultKind::kTimeout, "target", "mute"); };
  const Standstill stands = AfterTheStop(bench);
  EXPECT_FALSE(stands.is_sure);
  EXPECT_EQ(stands.why_not, "target: mute");
  EXPECT_EQ(bench.reference.stops, 1);
}

TEST(RealBench, IsBroughtBackToTheLastStopFromTheSideItWasApproachedFrom) {
  ScriptedBench scripted;
  test::MemoryLog log;
  const std::vector<double> moves = MovesAfterAFault(scripted, TwoSetups(), 3, log);
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
  MovesAfterAFault(scripted, TwoSetups(), 36, log);  // the first reading of set-up 1
  EXPECT_EQ(scripted.fixture.setups, (std::vector<int>{0, 1}));
  EXPECT_EQ(log.readings.size(), 72u);
}

TEST(RealBench, WaitsForNoMountingThatAPersonSaysIsDone) {
  Scenario scenario = TwoSetups();
  RotaryOf(scenario).procedure.remount_s = 1000.0;
  for (const bool by_hand : {false, true}) {
    ScriptedBench scripted;
    test::MemoryLog log;
    RotaryBench bench = scripted.Bench();
    Options options;
    options.log = &log;
    options.hand_ends_mounting = by_hand;
    CarryOut(bench, scenario, log, {}, options);
    const double took_s = ToSeconds(log.readings.back().time.time_since_epoch());
    EXPECT_EQ(took_s > 2000.0, !by_hand) << "twice remount_s, or none";
    EXPECT_EQ(took_s < 1000.0, by_hand) << took_s;
    const bool is_said = log.events[0].text.find(kMountedByHand) != std::string::npos;
    EXPECT_EQ(is_said, by_hand) << log.events[0].text;
  }
}

TEST(RealBench, FindsItsOriginAgainAfterARestartOfTheController) {
  ScriptedBench scripted;
  test::MemoryLog log;
  bool restarted = false;
  test::TroubledBench troubled(scripted.Bench(), [&](const std::string&, const std::string&, CallAnswer&) {
    if (restarted || log.readings.size() != 5) return;
    restarted = true;
    scripted.target.state.referenced = false;
    scripted.target.state.encoder_rad = 0.0;
  });
  RotaryBench bench = troubled.Bench();
  Options options;
  options.log = &log;
  CarryOut(bench, TwoSetups(), log, {}, options);
  EXPECT_EQ(scripted.target.homes, 1);
  EXPECT_EQ(scripted.reference.homes, 0);
  EXPECT_EQ(log.attempts.size(), 1u);
  EXPECT_EQ(log.attempts[0].fault, "restarted");
}

TEST(RealBench, KeepsNoReadingAboutWhichATableHadLostItsOrigin) {
  for (const char* asked_last : {"thermometer", "adc"}) {  // before the look before the block, and the one behind it
    ScriptedBench scripted;
    test::MemoryLog log;
    bool restarted = false;
    test::TroubledBench troubled(scripted.Bench(), [&](const std::string& device, const std::string&, CallAnswer&) {
      if (restarted || log.readings.size() != 5 || device != asked_last) return;
      restarted = true;
      scripted.reference.state.referenced = false;
      scripted.reference.state.encoder_rad = kNaN;
    });
    RotaryBench bench = troubled.Bench();
    Options options;
    options.log = &log;
    CarryOut(bench, TwoSetups(), log, {}, options);
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
  test::TroubledBench troubled(scripted.Bench(), [&](const std::string&, const std::string&, CallAnswer&) {
    if (log.readings.size() != 5) return;
    scripted.target.state.referenced = false;
    scripted.target.state.encoder_rad = 0.0;
  });
  RotaryBench bench = troubled.Bench();
  Options options;
  options.log = &log;
  options.may_home = false;
  try {
    CarryOut(bench, TwoSetups(), log, {}, options);
    FAIL() << "it went on";
  } catch (const DeviceFault& fault) {
    EXPECT_NE(std::string(fault.what()).find("--allow-homing"), std::string::npos) << fault.what();
  }
  EXPECT_EQ(scripted.target.homes, 0);
  EXPECT_EQ(log.readings.size(), 5u);
}

}  // namespace
}  // namespace twinbench::procedure
