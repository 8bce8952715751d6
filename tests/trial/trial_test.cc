#include "tests/tools/program.h"

// A bench is a folder: one that the program does not ship (runout.cc) is run, separated, scored and diagnosed by
// the engines as they are.
namespace twinbench::test {
namespace {

using testing::HasSubstr;

class Trial : public Program {
 protected:
  Trial() { Write("plain.toml", kPlain); }

  /// Readings of the plain bench with this hidden in it, as a file without any trace of it.
  void Hide(const std::string& readings, const std::string& effect, int seed = 1) {
    Write("hidden.toml", kPlain + effect);
    const std::string run = "run_" + readings;
    Succeed({"run", "hidden.toml", "--seed", std::to_string(seed), "-o", run});
    Write(readings, ReadingsOf(run));
  }
  nlohmann::json Diagnosis(const std::string& readings, const std::string& scenario = "plain.toml") {
    return Json({"diagnose", readings, "--scenario", scenario, "--json", "-", "-o", "extended.toml"});
  }

  const std::string kPlain = "bench = \"runout\"\nshaft.x_um = 4.0\n";
};

TEST_F(Trial, BenchHasFewerThan250Lines) {
  const std::string source = Contents(TWINBENCH_SOURCE_DIR "/tests/trial/runout.cc");
  EXPECT_LT(std::count(source.begin(), source.end(), '\n'), 250);
}

TEST_F(Trial, IsTheOnlyBenchOfItsProgram) {
  Write("other.toml", "bench = \"rotary_4dof\"\n");
  const Outcome refused = Call({"run", "other.toml", "-o", "run"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("runout"));
  EXPECT_THAT(Succeed({"help", "scenario"}), HasSubstr("runout_procedure"));
}

TEST_F(Trial, IsRunSeparatedAndScored) {
  Succeed({"run", "plain.toml", "-o", "run"});
  // Noise 0.1 um, 144 readings: 0.012 um along each axis.
  EXPECT_NEAR(Json({"separate", "run", "--json", "-"}).at("x_um").get<double>(), 4.0, 0.05);
  EXPECT_LT(Json({"score", "run", "--json", "-"}).at("error_um").get<double>(), 0.06);
  Write("r.csv", ReadingsOf("run"));
  EXPECT_THAT(Read("r.csv"), HasSubstr("shaft_deg,gauge_um"));
  Succeed({"import", "r.csv", "--scenario", "plain.toml", "-o", "again"});
  EXPECT_EQ(ReadingsOf("again"), Read("r.csv"));
}

TEST_F(Trial, OfItsOwnScenarioThereIsNothingToSay) {
  Hide("r.csv", "");
  EXPECT_EQ(Diagnosis("r.csv").at("verdict"), "none");
}

TEST_F(Trial, HiddenEffectIsNamedSizedAndPutIntoTheScenario) {
  Hide("r.csv", "[[effect]]\nname = \"warm_up\"\nsize_um = 1.5\ntime_constant_s = 150.0\n");
  const nlohmann::json found = Diagnosis("r.csv");
  EXPECT_EQ(found.at("verdict"), "named") << found.dump(2);
  const nlohmann::json& cause = found.at("causes").at(0);
  EXPECT_EQ(cause.at("effect"), "warm_up");
  const nlohmann::json& size = cause.at("parameters").at("size");
  EXPECT_NEAR(size.at("value").get<double>(), 1.5, 4.0 * size.at("u").get<double>());
  EXPECT_NEAR(cause.at("parameters").at("time_constant").at("value").get<double>(), 150.0, 60.0);
  Hide("second.csv", "[[effect]]\nname = \"warm_up\"\nsize_um = 1.5\ntime_constant_s = 150.0\n", 2);
  Write("believed.toml", Read("extended.toml"));
  EXPECT_EQ(Diagnosis("second.csv", "believed.toml").at("verdict"), "none") << "the extended scenario predicts";
}

TEST_F(Trial, TwoAtOnceAreBothNamed) {
  Hide("r.csv",
       "[[effect]]\nname = \"off_centre\"\nx_um = 0.5\ny_um = -0.8\n[[effect]]\nname = \"reversal\"\nwidth_um = "
       "0.6\n");
  const nlohmann::json found = Diagnosis("r.csv");
  std::set<std::string> names;
  for (const nlohmann::json& cause : found.at("causes")) names.insert(cause.at("effect"));
  EXPECT_EQ(names, (std::set<std::string>{"off_centre", "reversal"}));
}

TEST_F(Trial, StructureWithoutANameBecomesASignalThatPredictsAnotherRun) {
  const std::string lobes =
      "[[effect]]\nname = \"signal\"\npoint = \"gauge\"\nsignal = \"harmonic\"\nby = \"shaft\"\norder = 3\n"
      "amplitude_um = 1.0\n";
  Hide("r.csv", lobes);
  const nlohmann::json found = Diagnosis("r.csv");
  EXPECT_EQ(found.at("verdict"), "unknown") << found.dump(2);
  EXPECT_THAT(found.at("unknown").at("signature").get<std::string>(), HasSubstr("order 3 synchronous with shaft angle"));
  Hide("second.csv", lobes, 2);
  Write("believed.toml", Read("extended.toml"));
  EXPECT_THAT(Read("believed.toml"), HasSubstr("harmonic"));
  EXPECT_EQ(Diagnosis("second.csv", "believed.toml").at("verdict"), "none");
}

}  // namespace
}  // namespace twinbench::test
