#include "tests/tools/program_here.h"

// The commands on the turntable with autocollimator and on the hobbing machine.
namespace twinbench::test {
namespace {

using testing::HasSubstr;

class AngleBenches : public ProgramHere {
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
  for (const std::string bench : {"turntable", "hob"}) {
    const std::string a = bench + "_a", b = bench + "_b";
    Succeed({"run", bench + ".toml", "-o", a});
    Write("r.csv", ReadingsOf(a));
    Succeed({"import", "r.csv", "--scenario", bench + ".toml", "-o", b});
    EXPECT_EQ(Read(b + "/results.json"), Read(a + "/results.json")) << bench;
    EXPECT_EQ(ReadingsOf(b), ReadingsOf(a)) << bench;
  }
}

TEST_F(AngleBenches, TurntableIsSeparatedAndScored) {
  Succeed({"run", "turntable.toml", "-o", "a"});
  const nlohmann::json separation = Json({"separate", "a", "--json", "-"});
  EXPECT_EQ(separation.at("turntable").at("position_deg").size(), 12u);
  EXPECT_EQ(separation.at("turntable").at("u_ez_arcsec").size(), 12u);
  EXPECT_NEAR(separation.at("roll").at("gamma_mrad").get<double>(), 5.0, 2.0);
  EXPECT_FALSE(separation.at("not_separable").empty()) << "one shift gives the sum of both tables";
  const nlohmann::json score = Json({"score", "a", "--json", "-"});
  EXPECT_LT(score.at("turntable").at("ez").at("worst_error_arcsec").get<double>(), 0.6)
      << "noise 0.1, teeth 0.1 arcsec";
  EXPECT_EQ(Results("a").at("verification").at("after").at("count"), 24);
}

TEST_F(AngleBenches, PublishedEstimatorOfTheTurntableIsEquation5) {
  Succeed({"run", "turntable.toml", "-o", "a", "--noise-free"});
  EXPECT_THAT(Succeed({"separate", "a", "--estimator", "published"}), HasSubstr("harmonic model"));
  const nlohmann::json pointwise = Results("a").at("equation_5");
  EXPECT_EQ(pointwise.at("ez_arcsec").size(), 12u);
  EXPECT_EQ(pointwise.at("status").at(0), "near_pole") << "zero by zero at the start";
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

TEST_F(AngleBenches, HobbingMachineIsSeparatedAndScored) {
  Succeed({"run", "hob.toml", "-o", "a"});
  const nlohmann::json separation = Json({"separate", "a", "--json", "-"});
  EXPECT_NEAR(separation.at("two_positions").at("table_encoder_order_1").at("amplitude_arcsec").get<double>(),
              2e-6 / 0.1 / 4.84814e-6, 0.05);
  EXPECT_EQ(separation.at("transmission").size(), 2u) << "one a direction";
  EXPECT_NEAR(separation.at("transmission").at(0).at("amplitude_arcsec").at(0).get<double>(), 9.0, 0.05);
  const nlohmann::json score = Json({"score", "a", "--json", "-"});
  EXPECT_LT(score.at("table encoder").at("amplitude").at("worst_error_arcsec").get<double>(), 0.5);
}

TEST_F(AngleBenches, AreDiagnosedWithWhatIsHiddenInThem) {
  Succeed({"run", "turntable.toml", "-o", "a", "--set",
           "effect=[{ name = \"slip\", where = \"y\", step_arcsec = 5.0, at_reading = 30.0 }]"});
  const nlohmann::json found = Json({"diagnose", "a", "--scenario", "turntable.toml", "--json", "-"});
  EXPECT_EQ(found.at("verdict"), "named");
  EXPECT_EQ(found.at("causes").at(0).at("effect"), "slip");
  EXPECT_EQ(found.at("causes").at(0).at("where"), "y");
  Succeed({"run", "hob.toml", "-o", "b", "--set",
           "effect=[{ name = \"slip\", where = \"table\", step_arcsec = 20.0, at_reading = 300.0 }]"});
  const nlohmann::json hob = Json({"diagnose", "b", "--scenario", "hob.toml", "--json", "-"});
  EXPECT_THAT(hob.at("verdict"), testing::AnyOf("named", "tie"));
  EXPECT_EQ(hob.at("causes").at(0).at("effect"), "slip");
}

}  // namespace
}  // namespace twinbench::test
