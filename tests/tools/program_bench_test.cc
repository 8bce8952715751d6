#include "tests/tools/program_here.h"
#include "twin/core/reading_column.h"
#include "twin/core/run_record.h"

namespace twinbench::test {
namespace {

using testing::HasSubstr;

/// A bench that is a program of the user's own, of closed-form physics.
class ProgramBench : public ProgramHere {
 protected:
  ProgramBench() {
    Write("encoder.toml",
          "bench = \"encoder_comparison\"\nseed = 3\n[device]\nnoise_deg = 0.002\n[encoder_procedure]\n"
          "stops_per_turn = 36\npasses = [1, -1]\n");
    std::filesystem::copy(TWINBENCH_TEST_DATA "/program/acquire_encoder.py", At("acquire.py"));
  }

  /// @param options  Behind {readings}: eccentricity, play, mode.
  void WriteBench(const std::string& options, double timeout_s = 60.0) {
    std::string words;
    for (const std::string word : {"python3", "acquire.py", "{scenario}", "{stops}", "{readings}"})
      words += "\"" + word + "\", ";
    Write("bench.toml", "kind = \"program\"\nname = \"our own\"\ncommand = [" + words + options +
                            "]\ntimeout_s = " + std::to_string(timeout_s) + "\n");
  }

  Outcome Measure(const std::string& name) {
    return Call({"measure", "encoder.toml", "--bench", "bench.toml", "-o", name});
  }
};

TEST_F(ProgramBench, IsMeasuredAndDiagnosedLikeAnyOther) {
  WriteBench("\"0.02\"");
  ExpectEnded(Measure("run"), 0);
  const auto json = Json({"diagnose", "run", "--cache", "cache", "--json", "-"});
  std::vector<std::string> effects;
  for (const auto& cause : json.at("causes")) effects.push_back(cause.at("effect"));
  EXPECT_THAT(effects, testing::Contains("eccentricity")) << json.dump(1);
  EXPECT_EQ(json.at("readings"), 144);  // 36 stops, two turns, both ways
}

/// A program gets the plan only, and what it did not measure is not filled in from the twin that made the plan.
TEST_F(ProgramBench, NothingMeasuredComesFromTheTwin) {
  Write("rotary.toml", kSmall);
  std::filesystem::copy(TWINBENCH_TEST_DATA "/program/keep.py", At("keep.py"));
  const auto measured_by = [&](const std::string& scenario, const std::string& columns, const std::string& run) {
    Write("bench.toml", "kind = \"program\"\ncommand = [\"python3\", \"keep.py\", \"{stops}\", \"{readings}\", \"" + columns + "\"]\n");
    Call({"measure", scenario, "--bench", "bench.toml", "-o", run});
    return RunRecord::Open(At(run))->Readings();
  };
  const std::string volts = "psd_a_x_V,psd_a_y_V,psd_b_x_V,psd_b_y_V";
  for (const Reading& reading : measured_by("rotary.toml", volts, "rotary")) {
    EXPECT_TRUE(std::isnan(reading.temperature_degC));
    EXPECT_TRUE(reading.extra.empty()) << "encoders that nobody looked at";
  }
  EXPECT_THAT(Read("plan.csv"), testing::Not(HasSubstr("encoder")));
  for (const Reading& reading : measured_by("rotary.toml", volts + ",temperature_degC,target_encoder_after_deg", "looked")) {
    EXPECT_EQ(reading.temperature_degC, 0.25);
    EXPECT_EQ(reading.extra.at("target_encoder_after_deg"), "0.25");
  }

  Write("coast.toml",
        "bench = \"encoder_comparison\"\n[encoder_procedure]\nkind = \"coast\"\nturns = 2.0\nstamps_per_turn = 8\npasses = [1, -1]\n");
  const Quantity stamp_s{"stamp_s"};
  for (const Reading& reading : measured_by("coast.toml", "measured_deg", "unstamped"))
    EXPECT_TRUE(std::isnan(stamp_s(reading)));
  for (const Reading& reading : measured_by("coast.toml", "measured_deg,stamp_s", "stamped"))
    EXPECT_EQ(stamp_s(reading), 0.25);
}

TEST_F(ProgramBench, StopsWithoutRowsAndRowsThatNobodyAskedForAreSaidAndTheseLeftOut) {
  for (const std::string mode : {"missing", "extra"}) {
    WriteBench("\"0.02\", \"0\", \"" + mode + "\"");
    ExpectEnded(Measure(mode), 0, {mode == "missing" ? "the program read 130 of 144 measuring positions"
                                                     : "1 row is of no measuring position"});
  }
  EXPECT_EQ(Json({"diagnose", "extra", "--cache", "cache", "--json", "-"}).at("readings"), 144);
}

TEST_F(ProgramBench, OneThatHangsIsEndedAndOneThatFailsOrWritesNothingIsNoRun) {
  for (const std::string mode : {"hang", "fail", "silent"}) {
    WriteBench("\"0.02\", \"0\", \"" + mode + "\"", mode == "hang" ? 0.5 : 60.0);
    const Outcome measured = Measure(mode);
    EXPECT_EQ(measured.exit_code, 1) << mode;
    EXPECT_KEPT(measured.err.substr(0, measured.err.find('\n')));
    EXPECT_FALSE(Exists(mode + "/record.sqlite"));
  }
}

TEST_F(ProgramBench, ACommandMustSayWhereTheReadingsGo) {
  Write("bench.toml", "kind = \"program\"\ncommand = [\"python3\", \"acquire.py\"]\n");
  ExpectRefused({"measure", "encoder.toml", "--bench", "bench.toml", "-o", "run"}, "bench.toml:2: ");
}

TEST_F(ProgramBench, IsInvestigated) {
  WriteBench("\"0\", \"0.01\"");
  const std::vector<std::string> arguments = {
      "investigate", "encoder.toml", "--bench", "bench.toml", "--budget", "3h", "-o", "inquiry", "--set",
      "encoder_procedure.stops_per_turn=18", "--set", "encoder_procedure.turns=1"};
  Succeed(arguments);
  const auto found = nlohmann::json::parse(Read("inquiry/investigation.json"));
  ASSERT_EQ(found.at("told"), "named") << found.dump(1);
  EXPECT_EQ(found.at("causes").at(0).at("name"), "backlash");
  const auto& size = found.at("causes").at(0).at("effects").at(0).at("parameters");
  EXPECT_NEAR(std::abs(size.at("width_deg").get<double>()), 0.01, 4.0 * size.at("u_width_deg").get<double>());
  // Again, it takes up the runs that are there, and says the same.
  std::filesystem::remove(At("acquire.py"));
  Succeed(arguments);
  EXPECT_EQ(nlohmann::json::parse(Read("inquiry/investigation.json")), found);
}

}  // namespace
}  // namespace twinbench::test
