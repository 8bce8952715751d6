#include "tests/tools/program_here.h"
#include "twin/core/run_record.h"
#include "twin/core/units.h"

namespace twinbench::test {
namespace {

using testing::HasSubstr, testing::Not;

/// The small scenario as believed, and a run of it on a bench with a gain error of 1 % on PSD A x.
class Diagnose : public SmallProgram {
 protected:
  Diagnose() {
    BeginWith("diagnose", [this] {
      MakeRun("run", {"--set", "effect=[{name=\"psd_gain\", where=\"psd_a_x\", gain_error=0.01}]"});
      Succeed({"export", "run", "--readings", "readings.csv"});
      Succeed(Arguments({}));  // fills the cache
    });
  }
  std::vector<std::string> Arguments(const std::vector<std::string>& more) const {
    return With({"diagnose", "readings.csv", "--scenario", "small.toml", "--cache", "cache"}, more);
  }
};

/// Once a turn, there and back twice, without a time.
std::string OnceATurn() {
  std::string csv = "reference_deg,encoder_deg\n";
  for (int k = 0; k < 4 * 72; ++k) {
    const int step = k % 144 < 72 ? k % 72 : 71 - k % 72;
    const double noise_deg = 2e-4 * ((k * 37) % 11 - 5);  // even from -0.001 to +0.001
    csv += fmt::format("{},{:.6f}\n", 5 * step, 5.0 * step + 0.01 * std::cos((5.0 * step + 30.0) * units::deg) + noise_deg);
  }
  return csv;
}

TEST_F(Diagnose, SaysWhatResolvesAnAmbiguityAndNothingOfATimeThatNobodyMeasured) {
  Write("mine.csv", OnceATurn());
  Succeed({"import", "mine.csv", "-o", "mine"});
  const std::string text = Succeed({"diagnose", "mine", "--cache", "cache", "--verbose"});
  EXPECT_THAT(text, HasSubstr("Ambiguous: eccentricity or signal_offset"));
  EXPECT_THAT(text, HasSubstr("Next: device.signal_periods"));
  EXPECT_THAT(text, HasSubstr("another mounting"));
  for (const char* of_time : {"mHz", "along the time", "(period "}) EXPECT_THAT(text, Not(HasSubstr(of_time)));
  for (const auto& [channel, curve] : nlohmann::json::parse(Read("mine/results.json")).at("diagnosis").at("plots").at("against").value("time_s", nlohmann::json::object()).items())
    EXPECT_LE(curve.at("x").size(), 1u) << channel;
}

TEST_F(Diagnose, NamesTheHiddenCauseAndExtendsTheScenario) {
  const auto json = Json(Arguments({"--json", "-", "-o", "extended.toml"}));
  EXPECT_EQ(json.at("verdict"), "named") << json.dump(1);
  const auto& cause = json.at("causes").at(0);
  EXPECT_EQ(cause.at("effect"), "psd_gain");
  EXPECT_EQ(cause.at("where"), "psd_a_x");
  const auto& gain = cause.at("parameters").at("gain_error");
  EXPECT_NEAR(gain.at("value"), 0.01, 4.0 * gain.at("u").get<double>());
  EXPECT_EQ(json.at("extended_scenario"), "extended.toml");
  EXPECT_TRUE(json.at("gain").at("positive"));
  // The extended scenario runs on the twin, and explains the readings.
  Succeed({"run", "extended.toml", "-o", "again"});
  const auto again =
      Json({"diagnose", "readings.csv", "--scenario", "extended.toml", "--cache", "cache", "--json", "-"});
  EXPECT_EQ(again.at("verdict"), "none") << again.dump(1);
}

TEST_F(Diagnose, OfAFolderPutsPlotsWordsAndTestsOfTheResidualsIntoItsResults) {
  const auto before = nlohmann::json::parse(Read("run/results.json"));
  const std::string text =
      Succeed({"diagnose", "run", "--scenario", "small.toml", "--cache", "cache", "--json", "d.json"});
  EXPECT_THAT(text, testing::StartsWith("Cause identified: psd_gain at psd_a_x, gain error 0.0"));
  EXPECT_THAT(text, HasSubstr("Residual of psd_a_x [µm] against the angle"));
  EXPECT_THAT(text, Not(HasSubstr("\x1b"))) << "a pipe is no terminal";
  auto results = nlohmann::json::parse(Read("run/results.json"));
  const auto diagnosis = results.at("diagnosis");
  EXPECT_EQ(diagnosis.at("causes"), nlohmann::json::parse(Read("d.json")).at("causes"));
  EXPECT_TRUE(diagnosis.at("plots").at("against").contains("time_s"));
  EXPECT_EQ(diagnosis.at("in_words"),
            Succeed({"diagnose", "run", "--scenario", "small.toml", "--cache", "cache", "--verbose"}));
  std::vector<std::string> names;
  for (const auto& test : diagnosis.at("screen")) {
    names.push_back(test.at("test"));
    for (const char* key : {"statistic", "p", "effect_um", "effect_arcsec", "reading", "items"})
      EXPECT_TRUE(test.contains(key)) << key;
  }
  EXPECT_THAT(names, testing::ElementsAre("fit to stated noise", "runs and autocorrelation", "periodogram",
                                          "normality", "variance by group"));
  // The gain of one channel shrinks what both tables show there, order by order.
  EXPECT_THAT(diagnosis.at("in_words").get<std::string>(), HasSubstr("of 5 show"));
  results.erase("diagnosis");
  EXPECT_EQ(results, before);
}

TEST_F(Diagnose, DoesNotNameAnEffectThatIsStruck) {
  const nlohmann::json diagnosis = Json(Arguments({"--json", "-", "--strike", "psd_gain"}));
  EXPECT_EQ(diagnosis.at("verdict"), "unknown") << "what it does to the readings is seen all the same";
  for (const auto& cause : diagnosis.at("causes")) EXPECT_NE(cause.at("effect"), "psd_gain");
}

TEST_F(Diagnose, DoesWithoutACache) {
  Write("file", "in the way");
  std::vector<std::string> arguments = Arguments({"--json", "-"});
  arguments[5] = "file/cache";
  ExpectEnded(Call(arguments), 0, {"calibrations are not kept"});
}

TEST_F(Diagnose, RefusesBadInputAndADesignWithoutRedundancy) {
  ExpectRefused(Arguments({"--strike", "psd_gian"}));
  ExpectRefused({"diagnose", "readings.csv"}, "--scenario");
  ExpectRefused(Arguments({"--follow"}));
  ExpectRefused({"diagnose", "run", "--follow", "--false-alarm-rate", "2"}, "between 0 and 1");
  MakeRun("two", {"--set", "procedure.shifts=[0, 1]", "--set", "procedure.passes=[1]"});
  ExpectEnded(Call({"diagnose", "two", "--cache", "cache"}), 2, {"leave 0 degrees of freedom", "a third mounting"});
}

TEST_F(Diagnose, FollowsACompleteRunToItsEnd) {
  const auto clean = Json({"diagnose", "run", "--follow", "--json", "-"});
  EXPECT_TRUE(clean.at("complete"));
  EXPECT_TRUE(clean.at("alarms").empty()) << clean.dump(1);
  const auto json = Json({"diagnose", "run", "--follow", "--scenario", "small.toml", "--json", "-"});
  ASSERT_FALSE(json.at("alarms").empty());
  // A wrong scale of one x channel shows there and in the motions that are read from it.
  EXPECT_THAT(json.at("alarms").at(0).at("series"), testing::AnyOf("psd_a_x", "yaw", "lateral"));
}

/// Copies the readings of `from` into a new record, one after the other, as a bench would.
void Replay(const std::string& from, const std::string& to) {
  const auto source = RunRecord::Open(from);
  const auto record = RunRecord::Create(to, source->provenance());
  std::filesystem::copy(from + "/scenario.toml", to + "/scenario.toml");
  const std::vector<Reading> readings = source->Readings();
  for (std::size_t k = 0; k < readings.size(); ++k) {
    record->Append(readings[k], {});
    if (k % 20 == 19) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  record->Finish();
}

TEST_F(Diagnose, FollowsARunWhileItIsRecordedAndAlarmsBeforeItsEnd) {
  MakeRun("slip", {"--set", "effect=[{name=\"slip\", where=\"tilt\", angle_arcsec=20.0, at_reading=75}]"});
  std::filesystem::create_directory(At("live"));
  const std::jthread bench([&] { Replay(At("slip"), At("live")); });
  while (!Exists("live/scenario.toml")) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const Outcome outcome = Process(At(""), {"diagnose", "live", "--follow", "--scenario", "small.toml"}).Wait();
  ExpectEnded(outcome, 0);
  EXPECT_THAT(outcome.out, testing::AllOf(HasSubstr("alarm at reading 7"), HasSubstr(", complete; ")));
}

}  // namespace
}  // namespace twinbench::test
