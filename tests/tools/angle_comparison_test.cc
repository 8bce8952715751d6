#include "tests/tools/program_here.h"

namespace twinbench::test {
namespace {

using testing::HasSubstr;

class AngleComparison : public ProgramHere {
 protected:
  AngleComparison() {
    Write("angle.toml",
          "bench = \"encoder_comparison\"\n[encoder_procedure]\nturns = 1.0\nstops_per_turn = 36\n"
          "[[effect]]\nname = \"backlash\"\nwidth_deg = 1.0\n");
  }
};

TEST_F(AngleComparison, OfAPartOfATurnIsEvaluatedButNotSeparated) {
  Succeed({"run", "angle.toml", "-o", "a", "--set", "encoder_procedure.turns=0.5"});
  EXPECT_EQ(nlohmann::json::parse(Read("a/results.json")).at("not_separated"),
            "no mounting has a complete turn in one direction");
  for (const char* command : {"separate", "score"})
    ExpectRefused({command, "a"}, "no mounting has a complete turn in one direction");
}

TEST_F(AngleComparison, ReportsTheReversalOfABacklashItsIsoValuesAndWithOneMountingThatItIsTheDifferenceThatItKnows) {
  Succeed({"run", "angle.toml", "-o", "a"});
  const auto results = nlohmann::json::parse(Read("a/results.json"));
  // The gap is 1 deg; noise of 7.2 arcsec in 72 readings each way leaves 1.2 arcsec.
  EXPECT_NEAR(results.at("reversal").at("mean_arcsec"), -3600.0, 5.0);
  EXPECT_EQ(results.at("reversal").at("reversal_arcsec").size(), 360u);
  const auto& iso = results.at("iso230_2").at(0);
  EXPECT_EQ(iso.at("axis").size(), 12u);
  EXPECT_EQ(iso.at("targets").size(), 36u);
  EXPECT_NEAR(iso.at("axis").at("mean B").at("value_arcsec"), -3600.0, 5.0);
  EXPECT_THAT(iso.at("missing").dump(), HasSubstr("2 forward runs"));

  const auto separation = nlohmann::json::parse(Succeed({"separate", "a", "--json", "-"}));
  EXPECT_FALSE(separation.contains("reference"));
  ASSERT_EQ(separation.at("not_separable").size(), 1u);
  EXPECT_EQ(separation.at("not_separable")[0].at("what"), "device and reference");
  EXPECT_THAT(Succeed({"score", "a"}), HasSubstr("with one mounting"));
}

TEST_F(AngleComparison, RefusesReadingsOfAnotherBenchErrorsOfTablesAndImages) {
  Write("small.toml", kSmall);
  MakeRun("rotary");
  Write("r.csv", ReadingsOf("rotary"));
  ExpectRefused({"import", "r.csv", "--scenario", "angle.toml", "-o", "b"}, "measured_deg");
  ExpectRefused({"run", "angle.toml", "-o", "a", "--errors", "target=t.csv"});
  ExpectRefused({"run", "angle.toml", "-o", "a", "--images"});
}

// ... and on the turntable with autocollimator and on the hobbing machine.

class AngleBenches : public AngleComparison {
 protected:
  AngleBenches() {
    Write("turntable.toml",
          "bench = \"turntable_autocollimator\"\n"
          "turntable.harmonics = [{ order = 1, amplitude_arcsec = 6.0 }]\n"
          "autocollimator = { noise_arcsec = 0.1, roll_mrad = 5.0 }\n"
          "[turntable_procedure]\npositions = 12\ntilt_azimuths_deg = [0.0, 70.0]\nverification_positions = 24\n");
    Write("hob.toml",
          "bench = \"hob_transmission\"\n"
          "transmission.harmonics = [{ order = 1, amplitude_arcsec = 9.0, phase_deg = 30.0 }]\n"
          "table_encoder = { eccentricity_um = 2.0, noise_arcsec = 0.1 }\n"
          "[hob_procedure]\nheads_deg = [0.0, 170.0]\nturns = 2\nsamples_per_turn = 250\npoll_s = 5.0\n");
  }
  nlohmann::json Results(const std::string& run) { return nlohmann::json::parse(Read(run + "/results.json")); }
};

TEST_F(AngleBenches, AreCarriedOutExportedAndImportedToTheSameResults) {
  for (const std::string bench : {"turntable", "hob", "angle"}) {
    const std::string a = bench + "_a", b = bench + "_b";
    Succeed({"run", bench + ".toml", "-o", a});
    Write("r.csv", ReadingsOf(a));
    Succeed({"import", "r.csv", "--scenario", bench + ".toml", "-o", b});
    EXPECT_EQ(Read(b + "/results.json"), Read(a + "/results.json")) << bench;
    EXPECT_EQ(ReadingsOf(b), ReadingsOf(a)) << bench;
  }
}

TEST_F(AngleBenches, TurntableTakesErrorsFromAFile) {
  Write("t.csv", "position_deg,ez_arcsec\n0,0\n90,10\n180,0\n270,-10\n");
  Succeed({"run", "turntable.toml", "-o", "a", "--noise-free", "--errors", "turntable=t.csv", "--set",
           "multitooth.tooth_rms_arcsec=0"});
  const auto ez = Results("a").at("separation").at("turntable").at("ez_arcsec");
  EXPECT_NEAR(ez.at(3).get<double>() - ez.at(9).get<double>(), 20.0, 0.01);
  ExpectRefused({"run", "turntable.toml", "-o", "b", "--errors", "target=t.csv"},
                "turntable=FILE.csv or multitooth=FILE.csv");
}

}  // namespace
}  // namespace twinbench::test
