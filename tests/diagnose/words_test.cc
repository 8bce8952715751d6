#include <random>

#include "tests/diagnose/found_causes.h"
#include "tests/diagnose/ring_run.h"
#include "twin/core/units.h"
#include "twin/diagnose/disagreement.h"
#include "twin/diagnose/json.h"
#include "twin/diagnose/recurrence.h"
#include "twin/diagnose/words.h"

namespace twinbench::diagnose {
namespace {

using testing::HasSubstr;

TEST(WithUncertainty, HasTwoDigitsOfTheUncertaintyAndTellsSmallLengthsInMicrometres) {
  const auto text = [](double value, double u) {
    return WithUncertainty({"roll", "mrad", 1.0, value, u, kNaN, kNaN});
  };
  EXPECT_EQ(text(12.3456, 0.123), "12.35 ± 0.12 mrad");
  EXPECT_EQ(text(180000.0, 2345.0), "180000 ± 2345 mrad");
  EXPECT_EQ(text(0.01, 8e-6), "0.0100000 ± 0.0000080 mrad");
  EXPECT_EQ(text(0.01, 8e-12), "0.01 ± 8e-12 mrad");
  EXPECT_EQ(text(1.5, kNaN), "1.5 mrad");
  EXPECT_EQ(WithUncertainty({"width", "mm", 1e-3, 0.0004136e-3, 2.4e-9, kNaN, kNaN}), "0.4136 ± 0.0024 µm");
  EXPECT_EQ(WithUncertainty({"width", "mm", 1e-3, 0.25e-3, 0.01e-3, kNaN, kNaN}), "0.250 ± 0.010 mm");
}

TEST(Percent, TellsLittleFromNothingAndFromUnknown) {
  EXPECT_EQ(Percent(0.974), "97 %");
  EXPECT_EQ(Percent(0.004), "< 1 %");
  EXPECT_EQ(Percent(0.0), "0 %");
  EXPECT_EQ(Percent(-0.002), "0 %");
  EXPECT_EQ(Percent(kNaN), "-");
}

TEST(GainInWords, TellsSizesInTheUnitOfTheRunAndWarnsOfAModelThatDoesNotPredictBetter) {
  DiagnosisRun run = test::NamedRun(test::FoundPsdGain(0.003));
  EXPECT_THAT(GainInWords(run.diagnosis.gain, run.run), HasSubstr("from 0.71 to 0.31 um, noise alone leaves 0.3"));
  run.diagnosis.gain.positive = false;
  EXPECT_THAT(GainInWords(run.diagnosis.gain, run.run), HasSubstr("does not predict better"));
  run.diagnosis.gain.folds = 0;
  EXPECT_EQ(GainInWords(run.diagnosis.gain, run.run), "");
}

/// Readings with a direction of `size` that no unknown takes up, as found or not.
DiagnosisRun Off(double size_m, bool was_found) {
  DiagnosisRun found;
  found.run = test::MakeRing();
  test::AddRingNoise(found.run, 5);
  found.noise = test::WhiteNoise(found.run);
  Accepted direction = test::Direction(found.run);
  direction.amplitudes = Eigen::VectorXd::Constant(1, size_m);
  direction.family.amplitudes.front().prior_sd = size_m;
  // On both channels, that the middle of all rows shows it.
  for (int k = 0; k + 1 < found.run.Rows(); k += 2) direction.columns(k + 1, 0) = direction.columns(k, 0);
  found.run.residual += size_m * direction.columns;
  if (was_found) found.accepted = {direction};
  return found;
}

TEST(Disagreement, IsToldWhereItIsLargeAndCannotBeTrustedWhereNothingExplainsIt) {
  const Disagreement small = DisagreementOf(Off(1e-6, false)), explained = DisagreementOf(Off(1e-3, true)),
                     open = DisagreementOf(Off(1e-3, false));
  EXPECT_TRUE(small.is_plausible && explained.is_plausible && !open.is_plausible);
  EXPECT_EQ(small.line, "");
  EXPECT_THAT(explained.line, HasSubstr("times their noise; once all that was found is taken into account, by no more than their noise"));
  EXPECT_THAT(open.line, HasSubstr("are they of this bench"));
}

constexpr int kEightTurns = 480, kStopsOfATurn = 60;

/// Eight turns of one channel that shows a wave of five periods a turn.
LinearRun EightTurns() {
  LinearRun run;
  run.channels = {"angle"};
  Schedule& s = run.schedule = PlainSchedule(kEightTurns);
  run.observed.resize(kEightTurns);
  for (int i = 0; i < kEightTurns; ++i) {
    s.pass[static_cast<std::size_t>(i)] = i / kStopsOfATurn;
    s.reference_rad[i] = units::turn * i / kStopsOfATurn;
    run.observed[i] = std::sin(5.0 * s.reference_rad[i] + 0.1);
  }
  run.residual = Eigen::VectorXd::Zero(kEightTurns);
  return run;
}

TEST(Recurrence, OfScatteredValuesIsHardlyEverSeen) {
  const LinearRun run = EightTurns();
  std::mt19937_64 random(5);
  int seen = 0;
  constexpr int kTrials = 2000;
  for (int k = 0; k < kTrials; ++k) {
    std::vector<int> rows;
    for (int i = 0; i < kEightTurns; ++i) {
      if (random() % 60 == 0) rows.push_back(i);
    }
    seen += RecurrenceOf(rows, run).empty() ? 0 : 1;
  }
  EXPECT_LE(seen, kTrials / 250);
}

TEST(Recurrence, InARowAtOneAngleOrAtOneShownValueIsSaidButNotOfTwoValues) {
  const LinearRun run = EightTurns();
  const std::pair<std::vector<int>, const char*> cases[] = {
      {{200, 201, 202, 203, 377}, "in a row"},
      {{7, 67, 187, 247, 300}, "at 42 deg, synchronous with reference angle"},
      {{59, 179, 180, 299, 300, 420}, "at 354 deg, synchronous with reference angle"},  // on both sides of zero
      // The same crest in other periods: other angles.
      {{27, 75, 123 + 60 * 2, 171 + 60, 219 + 60 * 3, 3 + 60 * 7}, "where angle shows the same"}};
  for (const auto& [rows, words] : cases) EXPECT_THAT(RecurrenceOf(rows, run), HasSubstr(words));
  EXPECT_THAT(RecurrenceOf({59, 60, 119, 120}, run), testing::Not(HasSubstr("in a row"))) << "of two passes";
  EXPECT_EQ(RecurrenceOf({7, 67}, run), "");
}

using namespace test;
using nlohmann::json;
using testing::ElementsAre;

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

/// Numbers to twelve digits.
json Rounded(const json& value) {
  if (value.is_number_float()) return std::stod(fmt::format("{:.12g}", value.get<double>()));
  json rounded = value;
  for (json& part : rounded) {
    if (value.is_structured()) part = Rounded(part);
  }
  return rounded;
}

TEST(DiagnosisJson, HasTheAgreedKeysAndUnits) {
  // 0.71 um at 0.25 m/rad are 0.586 arcsec.
  const json agreed = json::parse(R"({
    "verdict": "named", "alarm_p": 0.0004, "unknown": {"probability": 0.02, "signature": "order 7"},
    "extended_scenario": "extended.toml",
    "gain": {"heldout_rms_before_um": 0.71, "heldout_rms_after_um": 0.31, "noise_floor_um": 0.3, "fraction_removed": 0.97,
             "interval95": [0.95, 0.99]}})");
  const json cause = json::parse(R"({
    "effect": "psd_roll", "where": "psd_a", "probability": 0.97, "next_measurement": "a tilt sweep",
    "indistinguishable_from": [{"effect": "psd_gain", "where": "psd_a_y", "overlap": 0.99}]})");
  const json out = Rounded(ToJson(Example(), "extended.toml"));
  const auto expect_has = [](const json& object, const json& part) {
    json merged = object;
    merged.merge_patch(part);
    EXPECT_EQ(object, merged);
  };
  expect_has(out, agreed);
  expect_has(out.at("causes").at(0), cause);
  expect_has(out.at("causes").at(0).at("parameters").at("roll"), {{"value", 3.1}, {"u", 0.2}, {"unit", "mrad"}});
  EXPECT_NEAR(out.at("gain").at("heldout_rms_before_arcsec"), 0.71e-6 / 0.25 / units::arcsec, 1e-9);
  EXPECT_EQ(out.at("invisible").at(0).at("could_bias"), "target ez up to 0.4 arcsec rms");
}

TEST(DiagnosisJson, GivesNullForWhatIsNotKnownAndOfAnAngleBenchForLengths) {
  const json out = ToJson(DiagnosisRun{}, "");
  EXPECT_EQ(out.at("verdict"), "none");
  EXPECT_TRUE(out.at("alarm_p").is_null());
  EXPECT_TRUE(out.at("causes").is_array() && out.at("causes").empty());
  EXPECT_TRUE(out.at("gain").at("heldout_rms_before_um").is_null());
  EXPECT_TRUE(out.at("gain").at("interval95").at(0).is_null());
  EXPECT_TRUE(out.at("extended_scenario").is_null());
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

TEST(DiagnosisPlots, ShowTheMissingSignalOfAChannelOrPatternAgainstItsVariableAndNothingAfter) {
  const json curves = PlotsJson(RingWithDirection()).at("against").at("direction"), curve = curves.at("a");
  EXPECT_THAT(curve.at("x"), ElementsAre(-1, 1));
  EXPECT_THAT(curve.at("n"), ElementsAre(72, 72));  // 3 set-ups, 2 passes a direction, 12 positions
  // ABBA passes: the direction is orthogonal to all unknowns and stays whole.
  EXPECT_NEAR(curve.at("before").at(0), -1.0, 1e-3);
  EXPECT_NEAR(curve.at("before").at(1), 1.0, 1e-3);
  // The amplitude has a prior of 3 um, which takes (0.3 / 3)^2 / 144 of it.
  EXPECT_NEAR(curve.at("after").at(0), 0.0, 1e-3);
  EXPECT_NEAR(curve.at("u").at(0), 0.3 / std::sqrt(72.0), 1e-4);
  // Of a pattern: half of channel a's signal is common to both; so is half of the variance of one channel.
  EXPECT_NEAR(curves.at("both").at("before").at(1), 0.5, 1e-3);
  EXPECT_NEAR(curves.at("both").at("u").at(0), 0.3 / std::sqrt(2.0 * 72.0), 1e-4);
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

TEST(DiagnosisPlots, MapEverySetUpAndPositionAndAreOfModestSize) {
  const json map = PlotsJson(RingWithDirection()).at("maps").at("a");
  EXPECT_THAT(map.at("setup"), ElementsAre(0, 1, 2));
  EXPECT_EQ(map.at("position").size(), 12u);
  EXPECT_EQ(map.at("before").size(), 3u);
  EXPECT_EQ(map.at("before").at(0).size(), 12u);
  EXPECT_NEAR(map.at("before").at(1).at(4), 0.0, 1e-3);  // both directions cancel in the mean
  // About 600 readings as on the reference bench: a page must load.
  DiagnosisRun run;
  run.run = MakeRing({36, {0, 1, 7, 11}, {1, -1, -1, 1}, 50});
  run.noise = WhiteNoise(run.run);
  EXPECT_LT(PlotsJson(run).dump().size(), 200000u);
}

}  // namespace
}  // namespace twinbench::diagnose
