#include <gtest/gtest.h>

#include "tests/core/input_error.h"
#include "tests/core/refusals.h"
#include "twin/core/scenario.h"
#include "twin/core/units.h"

/// [[effect]] blocks named "signal": structure that no cause of the catalogue has.
namespace twinbench {
namespace {

Scenario Parse(const std::string& bench, const std::string& block) {
  return ParseScenario("bench = \"" + bench + "\"\n[[effect]]\nname = \"signal\"\n" + block, "s.toml", ".");
}
std::string Refusal(const std::string& block) {
  return MessageOf([&] { Parse("rotary_4dof", block); });
}

TEST(ScenarioSignal, IsReadInSIWithAnAmplitudeOfItsBenchsKind) {
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
  const std::string constant =
      "point = \"angle\"\nsignal = \"constant\"\ntimes = \"velocity\"\namplitude_arcsec = 2\n";
  const EffectSettings of_angles = Parse("encoder_comparison", constant).effects.at(0);
  EXPECT_DOUBLE_EQ(of_angles.parameters.at("amplitude"), 2.0 * units::arcsec);
  EXPECT_DOUBLE_EQ(of_angles.parameters.at("per"), 1.0 * units::deg);
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
  const std::string tone = "point = \"psd_a_x\"\nsignal = \"tone\"\n";
  ExpectRefused("s.toml", Refusal,
                {{2, "signal = \"tone\"\n"}, {2, "point = \"psd_a_x\"\n"},
                 {4, "point = \"psd_c_x\"\nsignal = \"tone\"\n"}, {5, "point = \"psd_a_x\"\nsignal = \"wobble\"\n"},
                 {2, "point = \"psd_a_x\"\nsignal = \"harmonic\"\n"}, {2, tone + "by = \"target\"\n"},
                 {6, tone + "order = 3\n"}, {6, tone + "about_K = 3\n"}, {6, tone + "where = \"psd_a\"\n"}});
}

}  // namespace
}  // namespace twinbench
