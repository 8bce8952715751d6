#include "twin/diagnose/json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/diagnose/found_causes.h"
#include "tests/diagnose/ring_run.h"

namespace twinbench::diagnose {
namespace {

using namespace test;
using nlohmann::json;
using testing::ElementsAre;
using testing::IsSupersetOf;

std::vector<std::string> KeysOf(const json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

/// A diagnosis with every field filled: the example of formats.md.
DiagnosisRun Example() {
  Cause cause = FoundCause("psd_roll", "psd_a", {"roll", "mrad", 1e-3, 3.1e-3, 2e-4, -0.5, 0.5});
  cause.indistinguishable_from = {{"psd_gain", "psd_a_y", 0.99}};
  cause.next_measurement = "a tilt sweep";
  DiagnosisRun run = NamedRun(cause);
  run.run.patterns = {{"yaw", Eigen::Vector4d(0.25, 0.0, 0.25, 0.0)}};  // metres per radian
  run.diagnosis.alarm_p = 0.0004;
  run.diagnosis.unknown = {0.02, "order 7"};
  run.diagnosis.invisible = {{"backlash", "target", "target ez up to 0.4 arcsec rms"}};
  return run;
}

TEST(DiagnosisJson, HasTheAgreedKeysAndUnits) {
  const json out = ToJson(Example(), "extended.toml");
  EXPECT_THAT(KeysOf(out),
              IsSupersetOf({"verdict", "alarm_p", "causes", "unknown", "gain", "invisible", "extended_scenario"}));
  EXPECT_EQ(out.at("verdict"), "named");
  EXPECT_EQ(out.at("alarm_p"), 0.0004);
  const json& cause = out.at("causes").at(0);
  EXPECT_EQ(cause.at("effect"), "psd_roll");
  EXPECT_EQ(cause.at("where"), "psd_a");
  EXPECT_EQ(cause.at("probability"), 0.97);
  const json& roll = cause.at("parameters").at("roll");
  EXPECT_DOUBLE_EQ(roll.at("value"), 3.1);
  EXPECT_DOUBLE_EQ(roll.at("u"), 0.2);
  EXPECT_EQ(roll.at("unit"), "mrad");
  EXPECT_EQ(cause.at("indistinguishable_from").at(0),
            json({{"effect", "psd_gain"}, {"where", "psd_a_y"}, {"overlap", 0.99}}));
  EXPECT_EQ(cause.at("next_measurement"), "a tilt sweep");
  EXPECT_EQ(out.at("unknown"), json({{"probability", 0.02}, {"signature", "order 7"}}));
  const json& gain = out.at("gain");
  EXPECT_DOUBLE_EQ(gain.at("heldout_rms_before_um"), 0.71);
  EXPECT_DOUBLE_EQ(gain.at("heldout_rms_after_um"), 0.31);
  EXPECT_DOUBLE_EQ(gain.at("noise_floor_um"), 0.30);
  EXPECT_EQ(gain.at("fraction_removed"), 0.97);
  EXPECT_EQ(gain.at("interval95"), json({0.95, 0.99}));
  // 0.71 um at 0.25 m/rad.
  EXPECT_NEAR(gain.at("heldout_rms_before_arcsec"), 0.71e-6 / 0.25 * 180.0 * 3600.0 / 3.14159265358979, 1e-9);
  EXPECT_EQ(out.at("invisible").at(0).at("could_bias"), "target ez up to 0.4 arcsec rms");
  EXPECT_EQ(out.at("extended_scenario"), "extended.toml");
}

TEST(DiagnosisJson, GivesNullForWhatIsNotKnown) {
  const json out = ToJson(DiagnosisRun{}, "");
  EXPECT_EQ(out.at("verdict"), "none");
  EXPECT_TRUE(out.at("alarm_p").is_null());
  EXPECT_TRUE(out.at("causes").is_array() && out.at("causes").empty());
  EXPECT_TRUE(out.at("gain").at("heldout_rms_before_um").is_null());
  EXPECT_TRUE(out.at("gain").at("interval95").at(0).is_null());
  EXPECT_TRUE(out.at("extended_scenario").is_null());
}

TEST(DiagnosisJson, OfAnAngleBenchHasNoLengths) {
  DiagnosisRun run = Example();
  run.run.unit = "deg";
  run.run.patterns.clear();
  run.diagnosis.gain.before_m = 2.0 * units::arcsec;
  const json gain = ToJson(run, "").at("gain");
  EXPECT_TRUE(gain.at("heldout_rms_before_um").is_null());
  EXPECT_NEAR(gain.at("heldout_rms_before_arcsec"), 2.0, 1e-12);
}

/// A ring whose channel a follows the direction of travel, before and after that cause is known.
DiagnosisRun RingWithDirection() {
  DiagnosisRun run;
  run.run = MakeRing();
  AddUnknowns(run.run, 3);
  const Accepted cause = Direction(run.run);
  run.run.residual += 1e-6 * cause.columns.col(0);
  run.noise = WhiteNoise(run.run);
  run.accepted = {cause};
  return run;
}

TEST(DiagnosisPlots, ShowTheMissingSignalAgainstItsVariableAndNothingAfter) {
  const json curve = PlotsJson(RingWithDirection()).at("against").at("direction").at("a");
  EXPECT_THAT(curve.at("x"), ElementsAre(-1, 1));
  EXPECT_THAT(curve.at("n"), ElementsAre(72, 72));  // 3 set-ups, 2 passes a direction, 12 positions
  // ABBA passes: the direction is orthogonal to all unknowns and stays whole.
  EXPECT_NEAR(curve.at("before").at(0), -1.0, 1e-3);
  EXPECT_NEAR(curve.at("before").at(1), 1.0, 1e-3);
  // The amplitude has a prior of 3 um, which takes (0.3 / 3)^2 / 144 of it.
  EXPECT_NEAR(curve.at("after").at(0), 0.0, 1e-3);
  EXPECT_NEAR(curve.at("u").at(0), 0.3 / std::sqrt(72.0), 1e-4);
}

TEST(DiagnosisPlots, OfAPatternAreItsProjection) {
  const json curve = PlotsJson(RingWithDirection()).at("against").at("direction").at("both");
  // Half of channel a's signal is common to both; so is half of the variance of one channel.
  EXPECT_NEAR(curve.at("before").at(1), 0.5, 1e-3);
  EXPECT_NEAR(curve.at("u").at(0), 0.3 / std::sqrt(2.0 * 72.0), 1e-4);
}

TEST(DiagnosisPlots, LeaveOutWhatDoesNotVaryOrWasNotRecorded) {
  DiagnosisRun run = RingWithDirection();
  run.run.schedule.temperature_degC.setConstant(kNaN);
  const json against = PlotsJson(run).at("against");
  EXPECT_FALSE(against.contains("dwell_s"));  // 1 s everywhere
  EXPECT_FALSE(against.contains("temperature_degC"));
  EXPECT_TRUE(against.contains("time_s"));
  EXPECT_EQ(against.at("target_deg").at("b").at("x").size(), 12u);
}

TEST(DiagnosisPlots, MapEverySetUpAndPosition) {
  const json map = PlotsJson(RingWithDirection()).at("maps").at("a");
  EXPECT_THAT(map.at("setup"), ElementsAre(0, 1, 2));
  EXPECT_EQ(map.at("position").size(), 12u);
  EXPECT_EQ(map.at("before").size(), 3u);
  EXPECT_EQ(map.at("before").at(0).size(), 12u);
  EXPECT_NEAR(map.at("before").at(1).at(4), 0.0, 1e-3);  // both directions cancel in the mean
}

TEST(DiagnosisPlots, AreOfModestSize) {
  // About 600 readings as on the reference bench: a page must load.
  DiagnosisRun run;
  run.run = MakeRing({36, {0, 1, 7, 11}, {1, -1, -1, 1}, 50});
  run.noise = WhiteNoise(run.run);
  EXPECT_LT(PlotsJson(run).dump().size(), 200000u);
}

}  // namespace
}  // namespace twinbench::diagnose
