#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "hw_bridge/ad/block_checks.h"
#include "hw_bridge/ad/lost_word.h"
#include "hw_bridge/ad/negotiation.h"
#include "tests/support/served_run.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/sim/ad_sampler.h"

/// Faults of real benches, each struck on a served twin while the real procedure drives it through the real
/// backends. Where trying again is the answer, the readings are those of a run without any fault, to the bit.
namespace twinbench::test {
namespace {

using testing::HasSubstr;

constexpr int kAt = 14;  // readings kept when the fault strikes: in the middle of the first full circle

// --- what is tried again ---

struct TriedAgain {
  const char* name;
  const char* injected;
  std::vector<std::string> noticed_as;  // any of these is the right name
  const char* tables = "scpi";
  std::size_t attempts = 1;
  friend void PrintTo(const TriedAgain& row, std::ostream* out) { *out << row.name; }
};

class FaultThatIsTriedAgain : public ::testing::TestWithParam<TriedAgain> {};

TEST_P(FaultThatIsTriedAgain, CostsOneAttemptAndNoBit) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.tables = GetParam().tables;
  options.faults[kAt] = GetParam().injected;
  const ServedRun run = RunServed(served, scenario, options);
  EXPECT_EQ(run.stopped_by, "") << run.said;
  EXPECT_EQ(run.Readings(), InProcess(scenario));
  ASSERT_FALSE(run.log.attempts.empty()) << "the log shows it";
  EXPECT_LE(run.log.attempts.size(), GetParam().attempts);
  EXPECT_EQ(run.log.attempts[0].reading, kAt);
  EXPECT_THAT(GetParam().noticed_as, testing::Contains(run.log.attempts[0].fault)) << run.log.attempts[0].text;
}

INSTANTIATE_TEST_SUITE_P(
    Matrix, FaultThatIsTriedAgain,
    ::testing::Values(
        TriedAgain{"ScansLostInABlock", "adc,gap", {"gap"}},
        TriedAgain{"ChannelSlip", "adc,slip", {"channel_slip"}}, TriedAgain{"StuckChannel", "adc,stuck", {"stuck"}},
        TriedAgain{"ConnectionDroppedInABlock", "adc,drop", {"dropped"}},
        TriedAgain{"BlockThatStalls", "adc,stall", {"timeout"}},
        TriedAgain{"ShortBlock", "adc,short", {"dropped", "protocol"}},
        TriedAgain{"ErrorInABlock", "adc,error", {"dropped", "protocol"}},
        TriedAgain{"ConverterClockThatJumps", "clock,step", {"clock"}},
        TriedAgain{"MuteController", "target,mute", {"timeout"}},
        TriedAgain{"LateAnswer", "reference,late", {"timeout"}},
        TriedAgain{"HalfAnAnswer", "target,partial", {"timeout", "dropped", "protocol"}},
        TriedAgain{"ControllerThatHangsUp", "target,disconnect", {"dropped"}},
        TriedAgain{"ControllerRestarted", "target,restart", {"restarted"}},
        TriedAgain{"LostStep", "reference,lost_step", {"not_in_position"}},
        TriedAgain{"TableThatNeverSettles", "target,not_in_position", {"not_in_position"}},
        TriedAgain{"NeverSettlesByEsp", "reference,not_in_position", {"not_in_position"}, "esp"},
        TriedAgain{"MuteEsp", "target,mute", {"timeout"}, "esp"},
        TriedAgain{"LateEsp", "target,late", {"timeout"}, "esp"},
        TriedAgain{"HalfAnAnswerOfEsp", "reference,partial", {"timeout", "dropped", "protocol"}, "esp"},
        TriedAgain{"RestartedEsp", "reference,restart", {"restarted"}, "esp"},
        TriedAgain{"LostStepOfEsp", "target,lost_step", {"not_in_position"}, "esp"},
        TriedAgain{"MuteSerialLine", "target,mute", {"timeout"}, "pty"},
        // Behind that silence on a line that cannot be opened anew, the next question is late too.
        TriedAgain{"LateOnASerialLine", "target,late", {"timeout"}, "pty", 2},
        TriedAgain{"HalfAnAnswerOnASerialLine", "target,partial", {"timeout", "dropped", "protocol"}, "pty"}),
    [](const auto& row) { return row.param.name; });

TEST(FaultMatrix, AtTheVeryFirstReadingTheRunBeginsAgain) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.faults[0] = "adc,drop";
  const ServedRun run = RunServed(served, scenario, options);
  EXPECT_EQ(run.Readings(), InProcess(scenario)) << run.said;
  EXPECT_EQ(run.log.attempts.size(), 1u);
}

TEST(FaultMatrix, AFaultThatStaysUsesUpTheAttemptsAndTheRunCanBeResumed) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.faults[kAt] = "adc,gap,3";
  const ServedRun run = RunServed(served, scenario, options);
  EXPECT_EQ(run.stopped_by, "gap");
  EXPECT_EQ(run.log.attempts.size(), 3u);
  ASSERT_EQ(run.log.readings.size(), static_cast<std::size_t>(kAt));
  const ServedRun resumed = RunServed(served, scenario, {}, &run);
  EXPECT_EQ(resumed.Readings(), InProcess(scenario)) << resumed.said;
}

/// A controller that restarts while nothing moves is met by the next look at its encoder: that before the block or that behind it.
struct RestartedAboutABlock {
  const char* tables;
  const char* table;
  const char* when;  // the last device that is asked before it
  friend void PrintTo(const RestartedAboutABlock& row, std::ostream* out) {
    *out << row.tables << "_" << row.table << "_" << row.when;
  }
};

class RestartAboutABlock : public ::testing::TestWithParam<RestartedAboutABlock> {};

TEST_P(RestartAboutABlock, CostsOneAttemptAndLeavesNoCellEmpty) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.tables = GetParam().tables;
  bool struck = false;
  options.before_call = [&](const std::string& device, const std::string&, int kept) {
    if (struck || kept != kAt || device != GetParam().when) return;
    struck = true;
    Inject(served, std::string(GetParam().table) + ",restart");
  };
  const ServedRun run = RunServed(served, scenario, options);
  EXPECT_EQ(run.stopped_by, "") << run.said;
  EXPECT_EQ(run.Readings(), InProcess(scenario));
  ASSERT_EQ(run.log.attempts.size(), 1u);
  EXPECT_EQ(run.log.attempts[0].reading, kAt);
  EXPECT_EQ(run.log.attempts[0].fault, "restarted");
}

INSTANTIATE_TEST_SUITE_P(Matrix, RestartAboutABlock,
                         ::testing::Values(RestartedAboutABlock{"scpi", "target", "thermometer"},
                                           RestartedAboutABlock{"scpi", "reference", "adc"},
                                           RestartedAboutABlock{"esp", "reference", "thermometer"},
                                           RestartedAboutABlock{"esp", "target", "adc"}),
                         testing::PrintToStringParamName());

// --- a lost word where the levels of the channels are alike ---

/// What a word that is lost half-way through the block of a reading does, as it is foretold.
hw::LostWord Foretold(const Reading& reading, const AdcSettings& adc) {
  std::array<double, kChannels> level_lsb{}, noise_lsb{};
  for (std::size_t c = 0; c < kChannels; ++c) {
    level_lsb[c] = reading.mean_V[c] / sim::LsbOf(adc);
    noise_lsb[c] = reading.std_V[c] / sim::LsbOf(adc);
  }
  return hw::IfAWordWereLost(level_lsb, hw::ScanOrderOf(adc), hw::UsualNoise_lsb(noise_lsb), adc.samples, 1e-9);
}

/// The restless bench with amplifiers whose offsets bring the levels of reading kAt so far apart.
Scenario WithLevels(const std::array<double, kChannels>& levels_V) {
  Scenario scenario = RestlessBench();
  sim::Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  MemoryLog log;
  procedure::CarryOut(bench, scenario, log);
  for (std::size_t c = 0; c < kChannels; ++c)
    RotaryOf(scenario).amplifier.offset_V[c] = levels_V[c] - log.readings[kAt].mean_V[c];
  return scenario;
}

TEST(FaultMatrix, AWordIsLostUnseenWhereTheLevelsAreAlikeAndShiftsNoMeanByMoreThanSaid) {
  const Scenario scenario = WithLevels({0.0, 0.004, 0.008, 0.004});  // noise: 0.006 V a sample
  const AdcSettings& adc = RotaryOf(scenario).adc;
  const ServedTwin served(scenario);
  const ServedRun undisturbed = RunServed(served, scenario);
  const Reading& whole = undisturbed.log.readings.at(kAt);
  const hw::LostWord word = Foretold(whole, adc);
  ASSERT_FALSE(word.shows);
  RunOptions options;
  options.faults[kAt] = "adc,slip";
  const ServedRun run = RunServed(served, scenario, options);
  EXPECT_TRUE(run.log.attempts.empty());
  const Reading& hit = run.log.readings.at(kAt);
  for (std::size_t c = 0; c < kChannels; ++c) {
    const double chance_V = 3.0 * whole.std_V[c] / std::sqrt(adc.samples);  // of two halves of two channels
    EXPECT_NE(hit.mean_V[c], whole.mean_V[c]);
    EXPECT_NEAR(hit.mean_V[c], whole.mean_V[c], word.shift_lsb * sim::LsbOf(adc) + chance_V);
  }
}

TEST(FaultMatrix, AWordIsNeverLostUnseenWhereOffsetsKeepTheLevelsApart) {
  const Scenario scenario = WithLevels({-1.5, -0.5, 0.5, 1.5});
  const ServedTwin served(scenario);
  RunOptions options;
  for (int at = 0; at < 36; at += 5) options.faults[at] = "adc,slip";
  const ServedRun run = RunServed(served, scenario, options);
  EXPECT_EQ(run.log.attempts.size(), options.faults.size());
  EXPECT_EQ(run.Readings(), InProcess(scenario));
  for (const Reading& reading : run.log.readings) EXPECT_TRUE(Foretold(reading, RotaryOf(scenario).adc).shows);
}

// --- what ends the run until a hand has helped ---

struct NeedsAHand {
  const char* name;
  const char* injected;
  const char* stopped_by;
  friend void PrintTo(const NeedsAHand& row, std::ostream* out) { *out << row.name; }
};

class FaultThatNeedsAHand : public ::testing::TestWithParam<NeedsAHand> {};

TEST_P(FaultThatNeedsAHand, StopsTheRunWhichGoesOnAfterwards) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.faults[kAt] = GetParam().injected;
  options.alter = [](hw::BenchFile& file) { file.target_limits.stall_s = 3.0; };
  const ServedRun run = RunServed(served, scenario, options);
  EXPECT_EQ(run.stopped_by, GetParam().stopped_by) << run.said;
  EXPECT_EQ(run.log.readings.size(), static_cast<std::size_t>(kAt));
  EXPECT_EQ(run.log.attempts.size(), 1u);
  const ServedRun resumed = RunServed(served, scenario, {}, &run);
  EXPECT_EQ(resumed.Readings(), InProcess(scenario)) << resumed.said;
}

INSTANTIATE_TEST_SUITE_P(Matrix, FaultThatNeedsAHand,
                         ::testing::Values(NeedsAHand{"CableOff", "adc,float", "signal_lost"},
                                           NeedsAHand{"LimitSwitch", "target,limit", "limit"},
                                           NeedsAHand{"TableThatStandsStill", "target,stall", "stalled"}),
                         [](const auto& row) { return row.param.name; });

// --- what waits at a resume, and strikes while the bench is brought back to where the run was ---

class FaultPendingAtAResume : public ::testing::TestWithParam<const char*> {};

TEST_P(FaultPendingAtAResume, IsNotTakenForARecordThatDoesNotFit) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.faults[kAt] = "target,limit";  // ends the run
  const ServedRun run = RunServed(served, scenario, options);
  ASSERT_EQ(run.stopped_by, "limit") << run.said;
  RunOptions pending;
  pending.faults[0] = GetParam();  // of this program: before anything is asked
  const ServedRun resumed = RunServed(served, scenario, pending, &run);
  if (std::string(GetParam()) == "adc,float") {
    EXPECT_EQ(resumed.stopped_by, "signal_lost");
    EXPECT_THAT(resumed.said, HasSubstr("check the cable"));
    return;
  }
  EXPECT_EQ(resumed.stopped_by, "") << resumed.said;
  EXPECT_EQ(resumed.Readings(), InProcess(scenario));
  ASSERT_GT(resumed.log.attempts.size(), run.log.attempts.size()) << "and what it cost is written down";
  EXPECT_EQ(resumed.log.attempts.back().reading, kAt);
}

INSTANTIATE_TEST_SUITE_P(Matrix, FaultPendingAtAResume,
                         ::testing::Values("adc,drop", "adc,short", "adc,error", "adc,gap", "adc,saturate", "adc,float",
                                           "adc,stuck", "adc,hum", "adc,slip", "adc,no_light", "adc,saturate,2",
                                           "clock,step", "target,mute", "target,restart", "reference,restart", "target,disconnect", "target,lost_step",
                                           "reference,not_in_position", "target,limit", "reference,stall"));

TEST(FaultMatrix, AFaultThatStrikesAtEveryAttemptOfAResumeSaysWhatToDo) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.faults[kAt] = "target,limit";
  const ServedRun run = RunServed(served, scenario, options);
  RunOptions pending;
  pending.faults[0] = "adc,no_light,3";
  try {
    RunServed(served, scenario, pending, &run);
    FAIL() << "three attempts, three faults";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("as before, in 3 attempts"));
    EXPECT_THAT(error.what(), HasSubstr("look at the bench and go on with --resume"));
  }
}

// --- what is measured all the same ---

TEST(FaultMatrix, ASaturatedBlockIsFlaggedAndNeverAveraged) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.faults[kAt] = "adc,saturate";
  const ServedRun run = RunServed(served, scenario, options);
  EXPECT_EQ(run.stopped_by, "") << run.said;
  const Reading& hit = run.log.readings.at(kAt);
  EXPECT_EQ(hit.status, ReadingStatus::kSaturated);
  for (const double mean_V : hit.mean_V) EXPECT_TRUE(std::isnan(mean_V));
  EXPECT_EQ(run.log.readings.at(kAt + 1).status, ReadingStatus::kOk);
}

TEST(FaultMatrix, ABlockedBeamIsNoPosition) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.faults[kAt] = "adc,no_light";
  const ServedRun run = RunServed(served, scenario, options);
  const Reading& hit = run.log.readings.at(kAt);
  EXPECT_EQ(hit.status, ReadingStatus::kNoLight);
  for (const double mean_V : hit.mean_V) EXPECT_TRUE(std::isnan(mean_V));
}

TEST(FaultMatrix, HumIsMeasuredAllTheSame) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.faults[kAt] = "adc,hum";
  const ServedRun run = RunServed(served, scenario, options);
  EXPECT_EQ(run.stopped_by, "") << run.said;
  EXPECT_EQ(run.log.readings.at(kAt).status, ReadingStatus::kOk);
  EXPECT_TRUE(run.log.attempts.empty());
}

// --- what is refused before anything moves ---

TEST(FaultMatrix, ATravelBeyondTheSoftLimitsIsRefusedBeforeTheMove) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.alter = [](hw::BenchFile& file) { file.target_limits.upper_rad = 200.0 * units::deg; };
  const ServedRun run = RunServed(served, scenario, options);
  EXPECT_EQ(run.stopped_by, "limit");
  EXPECT_THAT(run.said, HasSubstr("240"));
  EXPECT_GT(run.log.readings.size(), 12u) << "up to there it was allowed";
}

TEST(FaultMatrix, ACardWithAnotherRateIsRefusedAndBothAreNamed) {
  Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RotaryOf(scenario).adc.rate_Hz = 100e3;
  const ServedRun run = RunServed(served, scenario);
  EXPECT_EQ(run.stopped_by, "refused");
  EXPECT_THAT(run.said, HasSubstr("62500"));
  EXPECT_THAT(run.said, HasSubstr("25000"));
}

TEST(FaultMatrix, ACardWithAnotherSerialNumberIsRefused) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.alter = [](hw::BenchFile& file) { file.adc.serial = "1716-0042"; };
  const ServedRun run = RunServed(served, scenario, options);
  EXPECT_EQ(run.stopped_by, "identity");
  EXPECT_THAT(run.said, HasSubstr("1716-0042"));
}

TEST(FaultMatrix, AnotherControllerAtTheAddressIsRefused) {
  const Scenario scenario = RestlessBench();
  const ServedTwin served(scenario);
  RunOptions options;
  options.alter = [](hw::BenchFile& file) {
    for (hw::ControlSettings* device :
         {&file.target, &file.reference, &file.autocollimator, &file.thermometer, &file.goniometer, &file.fixture})
      device->identity = "SmarAct";
  };
  EXPECT_EQ(RunServed(served, scenario, options).stopped_by, "identity");
}

}  // namespace
}  // namespace twinbench::test
