#include "tests/tools/program_here.h"

namespace twinbench::test {
namespace {

using testing::ElementsAre, testing::HasSubstr;

std::vector<std::string> KeysOf(const nlohmann::json& json) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

/// A run in the folder `run`, its readings in `readings.csv`.
class Evaluate : public ProgramHere {
 protected:
  Evaluate() {
    BeginWith("evaluate", [this] {
      Write("small.toml", kSmall);
      MakeRun("run");
      Succeed({"export", "run", "--readings", "readings.csv"});
    });
  }
};

TEST_F(Evaluate, ExportToAFileAndToStdoutIsTheSameAndAMessageOfTheFileSystemIsCodeOne) {
  EXPECT_EQ(Read("readings.csv"), Succeed({"export", "run", "--readings", "-"}));
  EXPECT_EQ(Call({"export", "run", "--readings", "again.csv"}).out, "");
  EXPECT_EQ(Call({"export", "run", "--readings", "no/such/folder.csv"}).exit_code, 1)
      << "a message of the file system";
  EXPECT_EQ(Call({"separate", "run", "--json", "no/such/folder.json"}).exit_code, 1);
}

TEST_F(Evaluate, SeparateRepeatsTheSeparationOfTheRun) {
  const auto results = nlohmann::json::parse(Read("run/results.json"));
  const auto again = Json({"separate", "run", "--json", "-"});
  for (const auto& [key, value] : again.items()) EXPECT_EQ(value, results.at("separation").at(key)) << key;
}

TEST_F(Evaluate, AnImportedRunSeparatesToTheSameNumbers) {
  Succeed({"import", "readings.csv", "--scenario", "small.toml", "-o", "imported"});
  EXPECT_EQ(Json({"separate", "imported", "--json", "-"}), Json({"separate", "run", "--json", "-"}));
  EXPECT_EQ(ReadingsOf("imported"), Read("readings.csv"));
}

TEST_F(Evaluate, AReadingsFileWithAScenarioSeparatesLikeTheFolder) {
  for (const char* estimator : {"rigorous", "published"}) {
    const auto from_file =
        Json({"separate", "readings.csv", "--scenario", "small.toml", "--json", "-", "--estimator", estimator});
    EXPECT_EQ(from_file, Json({"separate", "run", "--json", "-", "--estimator", estimator})) << estimator;
  }
}

TEST_F(Evaluate, SeparateWritesAFileAndPrintsForAPersonByWhichEstimatorItGaveWhichNumbers) {
  EXPECT_THAT(Succeed({"separate", "run", "--json", "s.json"}), HasSubstr("separation by the rigorous estimator"));
  const auto rigorous = Json({"separate", "run", "--json", "-"});
  EXPECT_EQ(nlohmann::json::parse(Read("s.json")), rigorous);
  EXPECT_THAT(Succeed({"separate", "run", "--estimator", "published"}),
              HasSubstr("separation by the published estimator"));
  EXPECT_NE(Json({"separate", "run", "--json", "-", "--estimator", "published"}).at("target").at("ex_arcsec"),
            rigorous.at("target").at("ex_arcsec"));
}

TEST_F(Evaluate, SeparateTakesOverrides) {
  // Who believes in PSDs at half the distance reads angles of about twice the size.
  const auto honest = Json({"separate", "run", "--json", "-"});
  const auto near =
      Json({"separate", "run", "--json", "-", "--set", "psd_a.distance_mm=100", "--set", "psd_b.distance_mm=100"});
  EXPECT_NE(honest.at("target").at("ez_arcsec"), near.at("target").at("ez_arcsec"));
}

TEST_F(Evaluate, SeparationJsonHasTheAgreedKeys) {
  const auto json = Json({"separate", "run", "--json", "-"});
  EXPECT_THAT(KeysOf(json), ElementsAre("dof", "not_separable", "reference", "residual_rms", "target"));
  for (const char* table : {"target", "reference"}) {
    const auto& estimate = json.at(table);
    EXPECT_EQ(estimate.at("position_deg").size(), 12u);
    for (const char* column : {"ex_arcsec", "ey_arcsec", "ez_arcsec", "dy_um"}) {
      EXPECT_EQ(estimate.at(column).size(), 12u) << column;
      EXPECT_EQ(estimate.at(std::string("u_") + column).size(), 12u) << column;
    }
  }
  ASSERT_FALSE(json.at("not_separable").empty());
  for (const auto& lost : json.at("not_separable")) EXPECT_THAT(KeysOf(lost), ElementsAre("what", "why"));
  EXPECT_TRUE(json.at("dof").is_number_integer());
  EXPECT_TRUE(json.at("residual_rms").is_object());
}

TEST_F(Evaluate, ScorePrintsEveryComponentAndIsWithinItsUncertainty) {
  const std::string text = Succeed({"score", "run"});
  const auto json = Json({"score", "run", "--json", "-"});
  for (const char* table : {"target", "reference"}) {
    for (const char* component : {"ex", "ey", "ez", "dy"}) {
      EXPECT_THAT(text, testing::ContainsRegex(std::string("\n") + table + " +" + component + " ")) << component;
      const auto& row = json.at(table).at(component);
      EXPECT_EQ(row.at("positions"), 12);
      // Mean of 12 correlated squares: 1 if the uncertainty is right; 5 would be a defect.
      EXPECT_LT(row.at("mean_chi2"), 5.0) << table << component;
    }
  }
  EXPECT_THAT(Succeed({"score", "run", "--positions"}), HasSubstr("position_deg"));
}

TEST_F(Evaluate, AUsersOwnResultIsScoredInTheProgramsTable) {
  Succeed({"separate", "run", "--tables", "mine.csv"});
  Succeed({"separate", "run", "--tables", "tables"});
  EXPECT_EQ(Read("mine.csv"), Read("tables/errors.csv"));
  EXPECT_THAT(Read("mine.csv"), HasSubstr("\ntarget.ez_arcsec[1],30,position_deg,"));
  const nlohmann::json same = Json({"score", "run", "--against", "mine.csv", "--json", "-"});
  EXPECT_NEAR(same.at("yours target").at("ez").at("rms_error_arcsec").get<double>(),
              same.at("twinbench target").at("ez").at("rms_error_arcsec").get<double>(), 1e-9);
  Write("other.csv", "result,value\ntarget.ez_arcsec[0],1e3\n");
  EXPECT_THAT(Succeed({"score", "run", "--against", "other.csv"}), HasSubstr("yours target      ez_arcsec"));
  Write("none.csv", "result,value\ntarget.ez_arcsek[0],1\n");
  ExpectRefused({"score", "run", "--against", "none.csv"}, "target.ez_arcsec[0]");
  Write("bare.csv", "name,value\ntarget.ez_arcsec[0],1\n");
  ExpectRefused({"score", "run", "--against", "bare.csv"}, "bare.csv:1");
}

TEST_F(Evaluate, ScoreNeedsATruth) {
  Succeed({"import", "readings.csv", "--scenario", "small.toml", "-o", "imported"});
  ExpectRefused({"score", "imported"}, "imported/truth.json");
}

}  // namespace
}  // namespace twinbench::test
