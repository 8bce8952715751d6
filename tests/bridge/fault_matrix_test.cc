#include "hw_bridge/ad/block_checks.h"
#include "hw_bridge/ad/lost_word.h"
#include "hw_bridge/ad/negotiation.h"
#include "tests/core/input_error.h"
#include "tests/support/served_run.h"
#include "tests/support/twin_run.h"
#include "twin/sim/ad_sampler.h"

/// Faults of real benches, each struck on a served twin while the real procedure drives it through the real
/// backends. Where trying again is the answer, the readings are those of a run without any fault, to the bit.
namespace twinbench::test {
namespace {

using testing::HasSubstr;

/// A served bench and what it gives where nothing is wrong with it.
struct Struck {
  explicit Struck(const Scenario& its_scenario = RestlessBench()) : scenario(its_scenario) {}
  /// @param faults  By how many readings are kept then.
  ServedRun Run(const std::map<int, std::string>& faults, const ServedRun* before = nullptr) {
    options.faults = faults;
    return RunServed(served, scenario, options, before);
  }
  ServedRun Run() { return RunServed(served, scenario, options); }
  void ExpectCarriedOutUndisturbed(const ServedRun& run) const {
    EXPECT_EQ(run.stopped_by, "") << run.said;
    EXPECT_EQ(run.Readings(), InProcess(scenario));
  }

  Scenario scenario;
  const ServedTwin served{scenario};
  RunOptions options;
};

constexpr int kAt = 14;  // readings kept when the fault strikes: in the middle of the first full circle

// --- what is tried again ---

struct TriedAgain {
  const char *name, *injected;
  std::vector<std::string> noticed_as;  // any of these is the right name
  const char* tables = "scpi";
  std::size_t attempts = 1;
  friend void PrintTo(const TriedAgain& row, std::ostream* out) { *out << row.name; }
};

class FaultThatIsTriedAgain : public ::testing::TestWithParam<TriedAgain> {};

TEST_P(FaultThatIsTriedAgain, CostsOneAttemptAndNoBit) {
  Struck bench;
  bench.options.tables = GetParam().tables;
  const ServedRun run = bench.Run({{kAt, GetParam().injected}});
  bench.ExpectCarriedOutUndisturbed(run);
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
        TriedAgain{"EspThatHangsUp", "target,disconnect", {"dropped"}, "esp"},
        TriedAgain{"HalfAnAnswerOfEsp", "reference,partial", {"timeout", "dropped", "protocol"}, "esp"},
        TriedAgain{"RestartedEsp", "reference,restart", {"restarted"}, "esp"},
        TriedAgain{"LostStepOfEsp", "target,lost_step", {"not_in_position"}, "esp"},
        TriedAgain{"MuteSerialLine", "target,mute", {"timeout"}, "pty"},
        // Behind that silence on a line that cannot be opened anew, the next question is late too.
        TriedAgain{"LateOnASerialLine", "target,late", {"timeout"}, "pty", 2},
        TriedAgain{"HalfAnAnswerOnASerialLine", "target,partial", {"timeout", "dropped", "protocol"}, "pty"}),
    [](const auto& row) { return row.param.name; });

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
  const std::vector<Reading> readings = RunTwin(scenario).readings;
  for (std::size_t c = 0; c < kChannels; ++c)
    RotaryOf(scenario).amplifier.offset_V[c] = levels_V[c] - readings[kAt].mean_V[c];
  return scenario;
}

TEST(FaultMatrix, AWordIsLostUnseenWhereTheLevelsAreAlikeAndShiftsNoMeanByMoreThanSaid) {
  Struck bench(WithLevels({0.0, 0.004, 0.008, 0.004}));  // noise: 0.006 V a sample
  const AdcSettings& adc = RotaryOf(bench.scenario).adc;
  const ServedRun undisturbed = bench.Run();
  const Reading& whole = undisturbed.log.readings.at(kAt);
  const hw::LostWord word = Foretold(whole, adc);
  ASSERT_FALSE(word.shows);
  const ServedRun run = bench.Run({{kAt, "adc,slip"}});
  EXPECT_TRUE(run.log.attempts.empty());
  const Reading& hit = run.log.readings.at(kAt);
  for (std::size_t c = 0; c < kChannels; ++c) {
    const double chance_V = 3.0 * whole.std_V[c] / std::sqrt(adc.samples);  // of two halves of two channels
    EXPECT_NE(hit.mean_V[c], whole.mean_V[c]);
    EXPECT_NEAR(hit.mean_V[c], whole.mean_V[c], word.shift_lsb * sim::LsbOf(adc) + chance_V);
  }
}

TEST(FaultMatrix, AWordIsNeverLostUnseenWhereOffsetsKeepTheLevelsApart) {
  Struck bench(WithLevels({-1.5, -0.5, 0.5, 1.5}));
  std::map<int, std::string> faults;
  for (int at = 0; at < 36; at += 5) faults[at] = "adc,slip";
  const ServedRun run = bench.Run(faults);
  EXPECT_EQ(run.log.attempts.size(), faults.size());
  EXPECT_EQ(run.Readings(), InProcess(bench.scenario));
  for (const Reading& reading : run.log.readings)
    EXPECT_TRUE(Foretold(reading, RotaryOf(bench.scenario).adc).shows);
}

// --- what ends the run until a hand has helped ---

TEST(FaultMatrix, WhatNeedsAHandStopsTheRunWhichGoesOnAfterwards) {
  for (const auto& [injected, stopped_by] :
       {std::pair{"adc,float", "signal_lost"}, {"target,limit", "limit"}, {"target,stall", "stalled"}}) {
    SCOPED_TRACE(injected);
    Struck bench;
    bench.options.alter = [](hw::BenchFile& file) { file.target_limits.stall_s = 3.0; };
    const ServedRun run = bench.Run({{kAt, injected}});
    EXPECT_EQ(run.stopped_by, stopped_by) << run.said;
    EXPECT_EQ(run.log.readings.size(), static_cast<std::size_t>(kAt));
    EXPECT_EQ(run.log.attempts.size(), 1u);
    bench.options = {};
    bench.ExpectCarriedOutUndisturbed(bench.Run({}, &run));
  }
}

// --- what waits at a resume, and strikes while the bench is brought back to where the run was ---

TEST(FaultMatrix, WhatIsPendingAtAResumeIsNotTakenForARecordThatDoesNotFit) {
  Struck bench;
  const ServedRun run = bench.Run({{kAt, "target,limit"}});  // ends the run
  ASSERT_EQ(run.stopped_by, "limit") << run.said;
  for (const std::string fault :
       {"adc,drop", "adc,short", "adc,error", "adc,gap", "adc,saturate", "adc,float", "adc,stuck", "adc,hum",
        "adc,slip", "adc,no_light", "adc,saturate,2", "clock,step", "target,mute", "target,restart",
        "reference,restart", "target,disconnect", "target,lost_step", "reference,not_in_position", "target,limit",
        "reference,stall"}) {
    SCOPED_TRACE(fault);
    const ServedRun resumed = bench.Run({{0, fault}}, &run);  // of this program: before anything is asked
    if (fault == "adc,float") {
      EXPECT_EQ(resumed.stopped_by, "signal_lost");
      EXPECT_THAT(resumed.said, HasSubstr("check the cable"));
      continue;
    }
    bench.ExpectCarriedOutUndisturbed(resumed);
    ASSERT_GT(resumed.log.attempts.size(), run.log.attempts.size()) << "and what it cost is written down";
    EXPECT_EQ(resumed.log.attempts.back().reading, kAt);
  }
  const std::string said = MessageOf([&] { bench.Run({{0, "adc,no_light,3"}}, &run); });  // at every attempt
  EXPECT_THAT(said, HasSubstr("as before, in 3 attempts"));
  EXPECT_THAT(said, HasSubstr("look at the bench and go on with --resume"));
}

// --- what is measured all the same ---

TEST(FaultMatrix, ASaturatedBlockAndABlockedBeamAreFlaggedAndNeverAveraged) {
  Struck bench;
  for (const auto& [fault, status] :
       {std::pair{"adc,saturate", ReadingStatus::kSaturated}, std::pair{"adc,no_light", ReadingStatus::kNoLight}}) {
    const ServedRun run = bench.Run({{kAt, fault}});
    EXPECT_EQ(run.stopped_by, "") << run.said;
    const Reading& hit = run.log.readings.at(kAt);
    EXPECT_EQ(hit.status, status);
    for (const double mean_V : hit.mean_V) EXPECT_TRUE(std::isnan(mean_V));
    EXPECT_EQ(run.log.readings.at(kAt + 1).status, ReadingStatus::kOk);
  }
}

TEST(FaultMatrix, HumIsMeasuredAllTheSame) {
  const ServedRun run = Struck().Run({{kAt, "adc,hum"}});
  EXPECT_EQ(run.stopped_by, "") << run.said;
  EXPECT_EQ(run.log.readings.at(kAt).status, ReadingStatus::kOk);
  EXPECT_TRUE(run.log.attempts.empty());
}

}  // namespace
}  // namespace twinbench::test
