#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/support/memory_log.h"
#include "tests/support/restless_bench.h"
#include "tests/support/troubled_bench.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/device_fault.h"

/// Faults, stops and resumed runs on the twin: whatever happens on the way, the readings are those of a run
/// without.
namespace twinbench::procedure {
namespace {

using test::MemoryLog;
using test::TextOf;
using test::TroubledBench;

std::vector<Reading> Undisturbed(const Scenario& scenario) {
  sim::Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  MemoryLog log;
  CarryOut(bench, scenario, log);
  return log.readings;
}

TEST(Recovery, AFaultAtAnyCallCostsAnAttemptAndChangesNoBit) {
  const Scenario scenario = test::RestlessBench();
  const std::string undisturbed = TextOf(Undisturbed(scenario));
  const std::vector<FaultKind> kinds = {FaultKind::kTimeout, FaultKind::kDropped, FaultKind::kGap,
                                        FaultKind::kNotInPosition, FaultKind::kRestarted};
  int calls_in_all = 1000000;
  for (int at = 0, k = 0; at < calls_in_all; at += 7, ++k) {
    sim::Twin twin(scenario);
    int calls = 0;
    bool failed = false;
    TroubledBench troubled(twin.Bench(), [&](const std::string& device, const std::string&, CallAnswer&) {
      if (calls++ != at || failed) return;
      failed = true;
      throw DeviceFault(kinds[static_cast<std::size_t>(k) % kinds.size()], device, "as asked for");
    });
    RotaryBench bench = troubled.Bench();
    MemoryLog log;
    Options options;
    options.log = &log;
    CarryOut(bench, scenario, log, {}, options);
    if (k == 0) calls_in_all = calls;
    ASSERT_EQ(TextOf(log.readings), undisturbed) << "fault at call " << at;
    ASSERT_EQ(log.attempts.size(), failed ? 1u : 0u);
  }
  EXPECT_GT(calls_in_all, 300);
}

TEST(Recovery, TheCallsThatAreKeptAreThoseOfARunWithoutFaults) {
  // They restore a simulated bench after the next fault, and play the run back.
  const Scenario scenario = test::RestlessBench();
  const auto calls_with_faults_at = [&](const std::set<int>& faults) {
    sim::Twin twin(scenario);
    int calls = 0;
    TroubledBench troubled(twin.Bench(), [&](const std::string& device, const std::string&, CallAnswer&) {
      if (faults.contains(calls++)) throw DeviceFault(FaultKind::kTimeout, device, "as asked for");
    });
    RotaryBench bench = troubled.Bench();
    MemoryLog log;
    Options options;
    options.log = &log;
    options.attempts = 10;
    CarryOut(bench, scenario, log, {}, options);
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
    for (const std::size_t kept :
         {std::size_t{1}, std::size_t{11}, std::size_t{12}, std::size_t{13}, undisturbed.size() - 1}) {
      MemoryLog log;
      {
        sim::Twin twin(scenario);
        RotaryBench bench = twin.Bench();
        Options options;
        options.log = &log;
        options.stop_requested = [&] { return log.readings.size() >= kept; };
        EXPECT_THROW(CarryOut(bench, scenario, log, {}, options), DeviceFault);
        ASSERT_EQ(log.readings.size(), kept);
      }
      sim::Twin twin(scenario);
      RotaryBench bench = twin.Bench();
      Options options;
      options.log = &log;
      options.readings_done = static_cast<int>(kept);
      options.calls_done = log.calls;
      CarryOut(bench, scenario, log, {}, options);
      EXPECT_EQ(TextOf(log.readings), TextOf(undisturbed)) << fidelity << ", taken up behind " << kept;
    }
  }
}

TEST(Recovery, ARecordOfAnotherSeedIsNotContinued) {
  Scenario scenario = test::RestlessBench();
  MemoryLog log;
  {
    sim::Twin twin(scenario);
    RotaryBench bench = twin.Bench();
    Options options;
    options.log = &log;
    CarryOut(bench, scenario, log, {}, options);
  }
  scenario.seed = 12;
  sim::Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  Options options;
  options.readings_done = 5;
  options.calls_done = log.calls;
  EXPECT_THROW(CarryOut(bench, scenario, log, {}, options), InputError);
}

TEST(Recovery, AttemptsAreCountedForEachReadingAndEnd) {
  const Scenario scenario = test::RestlessBench();
  sim::Twin twin(scenario);
  MemoryLog log;
  TroubledBench troubled(twin.Bench(), [&](const std::string& device, const std::string&, CallAnswer&) {
    if (device == "adc" && log.readings.size() == 4)
      throw DeviceFault(FaultKind::kGap, "adc", "3 scans are missing");
  });
  RotaryBench bench = troubled.Bench();
  Options options;
  options.log = &log;
  options.attempts = 3;
  EXPECT_THROW(CarryOut(bench, scenario, log, {}, options), DeviceFault);
  EXPECT_EQ(log.readings.size(), 4u);
  ASSERT_EQ(log.attempts.size(), 3u);
  EXPECT_EQ(log.attempts[2].attempt, 3);
  EXPECT_EQ(log.attempts[2].fault, "gap");
  EXPECT_EQ(log.attempts[2].reading, 4);
}

TEST(Recovery, ARunThatNobodyWritesDownEndsWithItsFirstFault) {
  const Scenario scenario = test::RestlessBench();
  sim::Twin twin(scenario);
  int blocks = 0;
  TroubledBench troubled(twin.Bench(), [&](const std::string& device, const std::string&, CallAnswer&) {
    if (device == "adc" && ++blocks == 5) throw DeviceFault(FaultKind::kGap, "adc", "3 scans are missing");
  });
  RotaryBench bench = troubled.Bench();
  MemoryLog log;
  EXPECT_THROW(CarryOut(bench, scenario, log), DeviceFault) << "there are no calls to come back by";
  EXPECT_EQ(log.readings.size(), 4u);
}

TEST(Recovery, WhatNeedsAHandStopsTheTablesAtOnce) {
  for (const FaultKind kind :
       {FaultKind::kStalled, FaultKind::kFollowing, FaultKind::kLimit, FaultKind::kImplausible,
        FaultKind::kSignalLost, FaultKind::kStopped, FaultKind::kIdentity}) {
    const Scenario scenario = test::RestlessBench();
    sim::Twin twin(scenario);
    int stops = 0;
    TroubledBench troubled(twin.Bench(), [&](const std::string&, const std::string& request, CallAnswer&) {
      if (request == "stop") ++stops;
      if (request.starts_with("acquire")) throw DeviceFault(kind, "bench", "as asked for");
    });
    RotaryBench bench = troubled.Bench();
    MemoryLog log;
    Options options;
    options.log = &log;
    EXPECT_THROW(CarryOut(bench, scenario, log, {}, options), DeviceFault) << FaultName(kind);
    EXPECT_EQ(stops, 2) << FaultName(kind);
    EXPECT_EQ(log.attempts.size(), 1u) << FaultName(kind);
  }
}

TEST(Recovery, WhateverIsThrownTheTablesAreStopped) {
  const Scenario scenario = test::RestlessBench();
  sim::Twin twin(scenario);
  int stops = 0;
  TroubledBench troubled(twin.Bench(), [&](const std::string&, const std::string& request, CallAnswer&) {
    if (request == "stop") ++stops;
    if (request.starts_with("acquire")) throw std::runtime_error("something else");
  });
  RotaryBench bench = troubled.Bench();
  MemoryLog log;
  EXPECT_THROW(CarryOut(bench, scenario, log), std::runtime_error);
  EXPECT_EQ(stops, 2);
}

TEST(Recovery, AnImplausibleRoomOrAJumpOfTheSpotStopsTheRun) {
  const Scenario scenario = test::RestlessBench();
  const auto fault_of = [&](const TroubledBench::Trouble& after, const Options& options) {
    sim::Twin twin(scenario);
    TroubledBench troubled(twin.Bench(), {}, after);
    RotaryBench bench = troubled.Bench();
    MemoryLog log;
    try {
      CarryOut(bench, scenario, log, {}, options);
    } catch (const DeviceFault& fault) {
      return std::string(FaultName(fault.kind())) + " of " + fault.device();
    }
    return std::string("none");
  };
  Options options;
  options.hottest_degC = 60.0;
  options.jump_V = 0.5;
  EXPECT_EQ(fault_of({}, options), "none");
  const auto hot = [](const std::string& device, const std::string&, CallAnswer& answer) {
    if (device == "thermometer") answer.text = "850";
  };
  EXPECT_EQ(fault_of(hot, options), "implausible of thermometer");
  int blocks = 0;
  const auto slipped = [&](const std::string& device, const std::string&, CallAnswer& answer) {
    if (device == "adc" && ++blocks > 20) answer.block.channel[2].mean_V += 0.6;
  };
  EXPECT_EQ(fault_of(slipped, options), "implausible of psd_b_x");
}

TEST(Recovery, AFifoThatIsTooSmallEndsTheRunInsteadOfLosingEveryReading) {
  Scenario scenario = test::RestlessBench();
  RotaryOf(scenario).adc.fifo_samples = 64;
  RotaryOf(scenario).adc.drain_rate_Hz = 100e3;  // slower than the converter
  sim::Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  MemoryLog log;
  Options options;
  options.log = &log;
  EXPECT_THROW(CarryOut(bench, scenario, log, {}, options), DeviceFault);
  EXPECT_TRUE(log.readings.empty());
  ASSERT_EQ(log.attempts.size(), 3u);
  EXPECT_EQ(log.attempts[2].fault, "overrun");
}

TEST(Recovery, ABlockFromAnotherTimeIsTakenAgain) {
  const Scenario scenario = test::RestlessBench();
  sim::Twin twin(scenario);
  int blocks = 0;
  TroubledBench troubled(twin.Bench(), {}, [&](const std::string& device, const std::string&, CallAnswer& answer) {
    if (device == "adc" && ++blocks == 9) answer.block.start += std::chrono::seconds(1);
  });
  RotaryBench bench = troubled.Bench();
  MemoryLog log;
  Options options;
  options.log = &log;
  CarryOut(bench, scenario, log, {}, options);
  EXPECT_EQ(TextOf(log.readings), TextOf(Undisturbed(scenario)));
  ASSERT_EQ(log.attempts.size(), 1u);
  EXPECT_EQ(log.attempts[0].fault, "clock");
}

TEST(Recovery, TheOperatorIsHeardWhileAMountingComesToRest) {
  const Scenario scenario = test::RestlessBench();  // remount_s is 60 s
  sim::Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  MemoryLog log;
  Options options;
  options.log = &log;
  options.stop_requested = [&] { return bench.clock.Now() > Time(std::chrono::seconds(20)); };
  EXPECT_THROW(CarryOut(bench, scenario, log, {}, options), DeviceFault);
  EXPECT_LT(bench.clock.Now(), Time(std::chrono::seconds(30)));
}

}  // namespace
}  // namespace twinbench::procedure
