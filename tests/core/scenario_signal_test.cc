#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/input_error.h"
#include "twin/core/scenario.h"
#include "twin/core/units.h"

/// [[effect]] blocks named "signal": structure that no cause of the catalogue has.
namespace twinbench {
namespace {

using testing::HasSubstr;

Scenario Parse(const std::string& bench, const std::string& block) {
  return ParseScenario("bench = \"" + bench + "\"\n[[effect]]\nname = \"signal\"\n" + block, "s.toml", ".");
}
std::string Refusal(const std::string& block) {
  return MessageOf([&] { Parse("rotary_4dof", block); });
}

TEST(ScenarioSignal, IsReadInSI) {
  const EffectSettings signal = Parse("rotary_4dof",
                                      "point = \"psd_b_y\"\nsignal = \"harmonic\"\nby = \"target\"\n"
                                      "times = \"temperature\"\norder = 3\namplitude_um = 1.5\nphase_deg = 40\n"
                                      "about_K = 0.2\nper_K = 0.5\n")
                                    .effects.at(0);
  EXPECT_EQ(signal.where, "psd_b_y");
  EXPECT_EQ(signal.signal, "harmonic");
  EXPECT_EQ(signal.by, "target");
  EXPECT_EQ(signal.times, "temperature");
  EXPECT_DOUBLE_EQ(signal.parameters.at("amplitude"), 1.5 * units::um);
  EXPECT_DOUBLE_EQ(signal.parameters.at("phase"), 40.0 * units::deg);
  EXPECT_EQ(signal.parameters.at("per"), 0.5);
}

TEST(ScenarioSignal, HasAnAmplitudeOfItsBenchsKind) {
  const EffectSettings signal =
      Parse("encoder_comparison",
            "point = \"angle\"\nsignal = \"constant\"\ntimes = \"velocity\"\namplitude_arcsec = 2\n")
          .effects.at(0);
  EXPECT_DOUBLE_EQ(signal.parameters.at("amplitude"), 2.0 * units::arcsec);
  EXPECT_DOUBLE_EQ(signal.parameters.at("per"), 1.0 * units::deg);
}

TEST(ScenarioSignal, IsWrittenAsItIsRead) {
  const Scenario scenario =
      Parse("turntable_autocollimator", "point = \"y\"\nsignal = \"share\"\nby = \"x\"\nshare = 0.01\n");
  const Scenario again = ParseScenario(WriteScenario(scenario), "again.toml", ".");
  EXPECT_EQ(WriteScenario(again), WriteScenario(scenario));
  EXPECT_EQ(again.effects.at(0).by, "x");
  EXPECT_EQ(again.effects.at(0).where, "y");
}

TEST(ScenarioSignal, IsRefusedWithWhatWasExpected) {
  EXPECT_THAT(Refusal("signal = \"tone\"\n"), HasSubstr("the signal has no point"));
  EXPECT_THAT(Refusal("point = \"psd_a_x\"\n"), HasSubstr("the signal has no signal"));
  EXPECT_THAT(Refusal("point = \"psd_c_x\"\nsignal = \"tone\"\n"), HasSubstr("\"psd_a_x\""));
  EXPECT_THAT(Refusal("point = \"psd_a_x\"\nsignal = \"wobble\"\n"), HasSubstr("\"harmonic\""));
  EXPECT_THAT(Refusal("point = \"psd_a_x\"\nsignal = \"harmonic\"\n"), HasSubstr("the signal has no by"));
  EXPECT_THAT(Refusal("point = \"psd_a_x\"\nsignal = \"tone\"\nby = \"target\"\n"), HasSubstr("goes by nothing"));
  EXPECT_THAT(Refusal("point = \"psd_a_x\"\nsignal = \"tone\"\norder = 3\n"), HasSubstr("has no order"));
  EXPECT_THAT(Refusal("point = \"psd_a_x\"\nsignal = \"tone\"\nabout_K = 3\n"), HasSubstr("has no about_K"));
  EXPECT_THAT(Refusal("point = \"psd_a_x\"\nsignal = \"tone\"\nwhere = \"psd_a\"\n"), HasSubstr("has no where"));
}

}  // namespace
}  // namespace twinbench
