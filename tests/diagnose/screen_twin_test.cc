#include <gmock/gmock.h>

#include "tests/diagnose/support/synthetic_run.h"
#include "tests/support/rotary_scenario.h"
#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/diagnosis/rotary_run.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/factory.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/scenario.h"
#include "twin/core/units.h"

/// Raw blocks as the twin's converter makes them.
namespace twinbench::diagnose {
namespace {

using testing::HasSubstr;

class RawSink : public ReadingSink {
 public:
  void Append(const Reading& reading, const Acquisition& block) override {
    readings.push_back(reading);
    if (!block.raw.empty()) blocks.push_back({reading.reading, kChannels, block.raw});
  }
  std::vector<Reading> readings;
  std::vector<RawBlock> blocks;
};

/// A short run that keeps its raw codes. Both tables wobble, so that the spots visit a few hundred codes.
Scenario SmallBench(std::uint64_t seed) {
  Scenario scenario = twinbench::test::RotaryScenario();
  scenario.seed = seed;
  RotaryOf(scenario).procedure.positions = 12;
  RotaryOf(scenario).procedure.shifts = {0, 1, 5};
  RotaryOf(scenario).procedure.passes = {1, -1};
  RotaryOf(scenario).procedure.keep_raw = true;
  for (TableSettings* table : {&RotaryOf(scenario).target, &RotaryOf(scenario).reference}) {
    for (int c = 0; c < kComponents; ++c) {
      table->random_rms[static_cast<std::size_t>(c)] =
          IsAngle(static_cast<Component>(c)) ? 2.0 * units::arcsec : 1.0 * units::um;
    }
  }
  return scenario;
}

std::vector<ScreenTest> ScreenOf(const Scenario& actual, const Scenario& believed) {
  sim::Twin twin(actual);
  RotaryBench bench = twin.Bench();
  RawSink sink;
  procedure::CarryOut(bench, actual, sink);
  const rotary::RotaryRun rotary = rotary::BuildRun(sink.readings, believed, {benches::rotary::FollowRecord});
  return ScreenRaw(sink.blocks, benches::rotary::RawScaleOf(believed, rotary.run), 200, actual.seed);
}

TEST(ScreenOfTheTwin, FindsTheMainsHumOfTheAmplifierWithItsAmplitude) {
  Scenario actual = SmallBench(1);
  RotaryOf(actual).adc.samples = 2500;  // 40 ms: two periods
  const Scenario believed = actual;
  RotaryOf(actual).amplifier.hum_V = 0.5 * units::mV;
  const auto tests = ScreenOf(actual, believed);
  const ScreenTest* hum = Find(tests, "raw: hum");
  ASSERT_NE(hum, nullptr);
  EXPECT_LT(hum->p, 1e-6);
  EXPECT_THAT(hum->reading, HasSubstr("a wave of 50 Hz"));
  // 0.5 mV at 2000 V/m; 6 mV of noise in 98 blocks of 2500: standard uncertainty 0.5 %, and the largest of four.
  EXPECT_NEAR(hum->effect_m, 0.25 * units::um, 0.03 * units::um);
}

TEST(ScreenOfTheTwin, FindsAMissingCodeOfTheConverter) {
  Scenario actual = SmallBench(1);
  RotaryOf(actual).adc.samples = 1000;
  const Scenario believed = actual;
  const double code_V = 20.0 / 65536.0;
  actual.effects.push_back({"adc_step", "psd_a_y", {{"step", code_V}, {"at_voltage", 20.5 * code_V}}, "test"});
  const auto tests = ScreenOf(actual, believed);
  const ScreenTest* codes = Find(tests, "raw: code density");
  ASSERT_NE(codes, nullptr);
  EXPECT_LT(codes->p, 1e-6);
  EXPECT_THAT(codes->reading, HasSubstr("code 21 of psd_a_y"));
  EXPECT_THAT(codes->reading, HasSubstr("(missing)"));
}

TEST(ScreenOfTheTwin, FindsTheGhostOfTheChannelScannedBefore) {
  Scenario actual = SmallBench(1);
  RotaryOf(actual).adc.samples = 1000;
  const Scenario believed = actual;
  actual.effects.push_back({"crosstalk", "psd_b_x", {{"fraction", 0.05}}, "test"});
  const auto tests = ScreenOf(actual, believed);
  const ScreenTest* settling = Find(tests, "raw: settling");
  ASSERT_NE(settling, nullptr);
  // 98 blocks of 1000 scans: 0.05 is 11 standard deviations.
  EXPECT_LT(settling->p, 1e-6);
  EXPECT_THAT(settling->reading, HasSubstr("of psd_a_y stays in psd_b_x"));
}

TEST(ScreenOfTheTwin, TellsNothingOfCleanBlocksButAtTheStatedRate) {
  constexpr int kRuns = 40;
  int told = 0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    Scenario clean = SmallBench(seed);
    RotaryOf(clean).adc.samples = 1500;
    const auto tests = ScreenOf(clean, clean);
    EXPECT_EQ(tests.size(), 5u);
    told += !Loud(tests).empty();
  }
  // 0.4 expected at 1 in 100; 4 or more has probability 0.001.
  EXPECT_LE(told, 3);
}

}  // namespace
}  // namespace twinbench::diagnose
