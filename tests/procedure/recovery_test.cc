#include "tests/procedure/troubled_run.h"

/// Faults, stops and resumed runs on the twin: whatever happens on the way, the readings are those of a run
/// without.
namespace twinbench::procedure {
namespace {

using test::MemoryLog, test::TextOf;

std::vector<Reading> Undisturbed(const Scenario& scenario = test::RestlessBench()) {
  MemoryLog log;
  EXPECT_EQ(EndOnTwin(log, {.is_written_down = false}, scenario), "none");
  return log.readings;
}

TEST(Recovery, AFaultAtAnyCallCostsAnAttemptAndChangesNoBit) {
  const std::string undisturbed = TextOf(Undisturbed());
  const std::vector<FaultKind> kinds = {FaultKind::kTimeout, FaultKind::kDropped, FaultKind::kGap,
                                        FaultKind::kNotInPosition, FaultKind::kRestarted};
  int calls_in_all = 1000000;
  for (int at = 0, k = 0; at < calls_in_all; at += 7, ++k) {
    int calls = 0;
    bool failed = false;
    const auto is_now = [&](const std::string&, const std::string&) {
      if (calls++ != at || failed) return false;
      return failed = true;
    };
    MemoryLog log;
    ASSERT_EQ(EndOnTwin(log, {.before = FailsIf(is_now, kinds[static_cast<std::size_t>(k) % kinds.size()])}), "none");
    if (k == 0) calls_in_all = calls;
    ASSERT_EQ(TextOf(log.readings), undisturbed) << "fault at call " << at;
    ASSERT_EQ(log.attempts.size(), failed ? 1u : 0u);
  }
  EXPECT_GT(calls_in_all, 300);
}

TEST(Recovery, TheCallsThatAreKeptAreThoseOfARunWithoutFaults) {
  // They restore a simulated bench after the next fault, and play the run back.
  const auto calls_with_faults_at = [](const std::set<int>& faults) {
    int calls = 0;
    const auto is_now = [&](const std::string&, const std::string&) { return faults.contains(calls++); };
    MemoryLog log;
    Course course{.before = FailsIf(is_now, FaultKind::kTimeout)};
    course.options.attempts = 10;
    EXPECT_EQ(EndOnTwin(log, course), "none");
    EXPECT_EQ(log.attempts.size(), faults.size());
    return log.calls;
  };
  const std::vector<DeviceCall> undisturbed = calls_with_faults_at({});
  EXPECT_EQ(calls_with_faults_at({100, 150, 250, 333}), undisturbed);
}

TEST(Recovery, ARunThatIsTakenUpByAnotherProgramIsTheUndisturbedOne) {
  for (const char* fidelity : {"kinematic", "linear", "bullet"}) {
    Scenario scenario = test::RestlessBench();
    RotaryOf(scenario).mechanics.fidelity = fidelity;
    const std::vector<Reading> undisturbed = Undisturbed(scenario);
    for (const std::size_t kept : {std::size_t{1}, std::size_t{11}, std::size_t{12}, std::size_t{13}, undisturbed.size() - 1}) {
      MemoryLog log;
      Course stopped, taken_up;
      stopped.options.stop_requested = [&] { return log.readings.size() >= kept; };
      EXPECT_NE(EndOnTwin(log, stopped, scenario), "none");
      ASSERT_EQ(log.readings.size(), kept);
      taken_up.options.kept = log.readings;
      taken_up.options.calls_done = log.calls;
      EXPECT_EQ(EndOnTwin(log, taken_up, scenario), "none");
      EXPECT_EQ(TextOf(log.readings), TextOf(undisturbed)) << fidelity << ", taken up behind " << kept;
    }
  }
}

/// A run on the twin's devices, of which nobody knows that they are simulated.
struct RealRun {
  RealRun() { bench.simulation = nullptr; }
  std::string End(Course course) { return EndOn(bench, scenario, log, course); }
  Scenario scenario = test::RestlessBench();
  sim::Twin twin{scenario};
  RotaryBench bench = twin.Bench();
  MemoryLog log;
};

/// Moves of the table under test from when a real bench's run is taken up to its next block.
/// @param elsewhere  What somebody did with the tables meanwhile.
int MovesUntilTheNextBlock(const std::function<void(RotaryBench&)>& elsewhere) {
  RealRun real;
  Course stopped, taken_up;
  stopped.options.stop_requested = [&] { return real.log.readings.size() >= 5; };
  EXPECT_NE(real.End(stopped), "none");
  elsewhere(real.bench);
  real.bench.clock.Wait(std::chrono::seconds(60));
  int moves = 0;
  bool is_next = false;
  taken_up.options.target.in_position_rad = taken_up.options.reference.in_position_rad = 5.0 * units::arcsec;
  taken_up.before = [&](const std::string& device, const std::string& request, CallAnswer&) {
    is_next = is_next || request.starts_with("acquire");
    moves += !is_next && device == "target" && request.starts_with("move");
  };
  taken_up.options.kept = real.log.readings;
  taken_up.options.calls_done = real.log.calls;
  EXPECT_EQ(real.End(taken_up), "none");
  return moves;
}

/// From the side from which it was approached: to behind the stop, and to it.
TEST(Recovery, ARealBenchGoesBackToItsLastStopIfEitherTableWasMovedMeanwhile) {
  const int moves = MovesUntilTheNextBlock([](RotaryBench&) {});
  const auto away = [](RotaryTable& table) { table.StartMove(table.EncoderAngle_rad() + 1.0 * units::deg); };
  EXPECT_EQ(MovesUntilTheNextBlock([&](RotaryBench& bench) { away(bench.target); }), moves + 2);
  EXPECT_EQ(MovesUntilTheNextBlock([&](RotaryBench& bench) { away(bench.reference); }), moves + 2);
}

TEST(Recovery, ARealBenchWhoseSpotsAreElsewhereBehindAFaultKeepsNoReadingMore) {
  for (const double shift_V : {0.0, 0.5}) {
    RealRun real;
    bool has_failed = false;
    Course course;
    course.before = [&](const std::string& device, const std::string&, CallAnswer&) {
      if (device != "adc" || real.log.readings.size() != 20 || has_failed) return;
      has_failed = true;
      throw DeviceFault(FaultKind::kTimeout, device, "as asked for");
    };
    course.after = [&](const std::string& device, const std::string&, CallAnswer& answer) {
      if (device == "adc" && has_failed) answer.block.channel[0].mean_V += shift_V;
    };
    EXPECT_EQ(real.End(course), shift_V > 0.0 ? "implausible of psd_a_x" : "none");
    EXPECT_EQ(real.log.readings.size() == 20u, shift_V > 0.0);
  }
}

TEST(Recovery, ATableThatSomebodyElseMovedAtRestIsToldBeforeItsNextMove) {
  RealRun real;
  bool was_moved = false;
  Course course;
  course.before = [&](const std::string&, const std::string&, CallAnswer&) {
    if (real.log.readings.size() != 20 || was_moved) return;
    was_moved = true;
    real.twin.Bench().reference.StartMove(real.twin.Bench().reference.EncoderAngle_rad() + 0.01 * units::deg);
  };
  EXPECT_EQ(real.End(course), "none");
  ASSERT_EQ(real.log.attempts.size(), 1u);
  EXPECT_EQ(real.log.attempts[0].fault, "moved");
}

TEST(Recovery, ARecordOfAnotherSeedIsNotContinued) {
  Scenario scenario = test::RestlessBench();
  MemoryLog log;
  EndOnTwin(log, {}, scenario);
  scenario.seed = 12;
  Course taken_up;
  taken_up.options.kept = {log.readings.begin(), log.readings.begin() + 5};
  taken_up.options.calls_done = log.calls;
  EXPECT_THROW(EndOnTwin(log, taken_up, scenario), InputError);
}

TEST(Recovery, AttemptsAreCountedForEachReadingAndEnd) {
  MemoryLog log;
  const auto is_fifth = [&](const std::string& device, const std::string&) {
    return device == "adc" && log.readings.size() == 4;
  };
  Course course{.before = FailsIf(is_fifth, FaultKind::kGap)};
  course.options.attempts = 3;
  EXPECT_EQ(EndOnTwin(log, course), "gap of adc");
  EXPECT_EQ(log.readings.size(), 4u);
  ASSERT_EQ(log.attempts.size(), 3u);
  EXPECT_EQ(log.attempts[2].attempt, 3);
  EXPECT_EQ(log.attempts[2].fault, "gap");
  EXPECT_EQ(log.attempts[2].reading, 4);
}

TEST(Recovery, ARunThatNobodyWritesDownEndsWithItsFirstFault) {
  int blocks = 0;
  const auto is_fifth = [&](const std::string& device, const std::string&) { return device == "adc" && ++blocks == 5; };
  MemoryLog log;
  EXPECT_EQ(EndOnTwin(log, {.before = FailsIf(is_fifth, FaultKind::kGap), .is_written_down = false}), "gap of adc")
      << "there are no calls to come back by";
  EXPECT_EQ(log.readings.size(), 4u);
}

TEST(Recovery, WhatNeedsAHandStopsTheTablesAtOnce) {
  for (const FaultKind kind :
       {FaultKind::kStalled, FaultKind::kFollowing, FaultKind::kLimit, FaultKind::kImplausible,
        FaultKind::kSignalLost, FaultKind::kStopped, FaultKind::kIdentity}) {
    int stops = 0;
    const auto is_block = [&](const std::string&, const std::string& request) {
      stops += request == "stop";
      return request.starts_with("acquire");
    };
    MemoryLog log;
    EXPECT_EQ(EndOnTwin(log, {.before = FailsIf(is_block, kind)}), std::string(FaultName(kind)) + " of adc");
    EXPECT_EQ(stops, 2) << FaultName(kind);
    EXPECT_EQ(log.attempts.size(), 1u) << FaultName(kind);
  }
}

TEST(Recovery, WhateverIsThrownTheTablesAreStopped) {
  int stops = 0;
  const auto throws = [&](const std::string&, const std::string& request, CallAnswer&) {
    stops += request == "stop";
    if (request.starts_with("acquire")) throw std::runtime_error("something else");
  };
  MemoryLog log;
  EXPECT_THROW(EndOnTwin(log, {.before = throws, .is_written_down = false}), std::runtime_error);
  EXPECT_EQ(stops, 2);
}

TEST(Recovery, AnImplausibleRoomOrAJumpOfTheSpotStopsTheRun) {
  const auto fault_of = [](const test::TroubledBench::Trouble& after) {
    MemoryLog log;
    Course course{.after = after, .is_written_down = false};
    course.options.hottest_degC = 60.0;
    course.options.jump_V = 0.5;
    return EndOnTwin(log, course);
  };
  EXPECT_EQ(fault_of({}), "none");
  const auto hot = [](const std::string& device, const std::string&, CallAnswer& answer) {
    if (device == "thermometer") answer.text = "850";
  };
  EXPECT_EQ(fault_of(hot), "implausible of thermometer");
  int blocks = 0;
  const auto slipped = [&](const std::string& device, const std::string&, CallAnswer& answer) {
    if (device == "adc" && ++blocks > 20) answer.block.channel[2].mean_V += 0.6;
  };
  EXPECT_EQ(fault_of(slipped), "implausible of psd_b_x");
}

TEST(Recovery, AFifoThatIsTooSmallEndsTheRunInsteadOfLosingEveryReading) {
  const Scenario scenario =
      Altered(test::RestlessBench(), {"adc.fifo_samples=64", "adc.drain_rate_kHz=100"});  // slow
  MemoryLog log;
  EXPECT_NE(EndOnTwin(log, {}, scenario), "none");
  EXPECT_TRUE(log.readings.empty());
  ASSERT_EQ(log.attempts.size(), 3u);
  EXPECT_EQ(log.attempts[2].fault, "overrun");
}

TEST(Recovery, ABlockFromAnotherTimeIsTakenAgain) {
  int blocks = 0;
  const auto late = [&](const std::string& device, const std::string&, CallAnswer& answer) {
    if (device == "adc" && ++blocks == 9) answer.block.start += std::chrono::seconds(1);
  };
  MemoryLog log;
  EXPECT_EQ(EndOnTwin(log, {.after = late}), "none");
  EXPECT_EQ(TextOf(log.readings), TextOf(Undisturbed()));
  ASSERT_EQ(log.attempts.size(), 1u);
  EXPECT_EQ(log.attempts[0].fault, "clock");
}

TEST(Recovery, TheOperatorIsHeardWhileAMountingComesToRest) {
  const Scenario scenario = test::RestlessBench();  // remount_s is 60 s
  sim::Twin twin(scenario);
  const auto now = [&] { return twin.Bench().clock.Now(); };
  MemoryLog log;
  Course course;
  course.options.stop_requested = [&] { return now() > Time(std::chrono::seconds(20)); };
  EXPECT_NE(EndOn(twin.Bench(), scenario, log, course), "none");
  EXPECT_LT(now(), Time(std::chrono::seconds(30)));
}

}  // namespace
}  // namespace twinbench::procedure
