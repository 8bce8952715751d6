#include <regex>

#include "tests/tools/program_here.h"
#include "tools/web/bundle.h"

namespace twinbench::test {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::Not;

std::vector<std::string> KeysOf(const nlohmann::json& json) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

/// A run in the folder `run`, its readings in `readings.csv`.
class Evaluate : public SmallProgram {
 protected:
  Evaluate() {
    BeginWith("evaluate", [this] {
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

TEST_F(Evaluate, AReadingsFileWithAScenarioSeparatesLikeTheFolder) {
  for (const char* estimator : {"rigorous", "published"}) {
    const auto from_file =
        Json({"separate", "readings.csv", "--scenario", "small.toml", "--json", "-", "--estimator", estimator});
    EXPECT_EQ(from_file, Json({"separate", "run", "--json", "-", "--estimator", estimator})) << estimator;
  }
}

TEST_F(Evaluate, SeparateWritesAFileAndPrintsForAPersonByWhichEstimatorItGaveWhichNumbersAndTakesOverrides) {
  EXPECT_THAT(Succeed({"separate", "run", "--json", "s.json"}), HasSubstr("separation by the rigorous estimator"));
  const auto rigorous = Json({"separate", "run", "--json", "-"});
  EXPECT_EQ(nlohmann::json::parse(Read("s.json")), rigorous);
  EXPECT_THAT(Succeed({"separate", "run", "--estimator", "published"}),
              HasSubstr("separation by the published estimator"));
  EXPECT_NE(Json({"separate", "run", "--json", "-", "--estimator", "published"}).at("target").at("ex_arcsec"),
            rigorous.at("target").at("ex_arcsec"));
  // Who believes in PSDs at half the distance reads angles of about twice the size.
  const auto near =
      Json({"separate", "run", "--json", "-", "--set", "psd_a.distance_mm=100", "--set", "psd_b.distance_mm=100"});
  EXPECT_NE(rigorous.at("target").at("ez_arcsec"), near.at("target").at("ez_arcsec"));
}

TEST_F(Evaluate, SeparationJsonHasTheAgreedKeysAndTheNumbersOfTheRun) {
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
  const auto of_run = JsonIn("run/results.json").at("separation");
  for (const auto& [key, value] : json.items()) EXPECT_EQ(value, of_run.at(key)) << key;
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

TEST_F(Evaluate, AUsersOwnResultIsScoredInTheProgramsTableAndNothingWithoutATruth) {
  Succeed({"separate", "run", "--tables", "mine.csv"});
  Succeed({"separate", "run", "--tables", "tables"});
  EXPECT_EQ(Read("mine.csv"), Read("tables/errors.csv"));
  EXPECT_THAT(Read("mine.csv"), HasSubstr("\ntarget.ez_arcsec[1],30,position_deg,"));
  const nlohmann::json same = Json({"score", "run", "--against", "mine.csv", "--json", "-"});
  EXPECT_NEAR(same.at("yours target").at("ez").at("rms_error_arcsec").get<double>(),
              same.at("twinbench target").at("ez").at("rms_error_arcsec").get<double>(), 1e-9);
  Write("other.csv", "result,value\ntarget.ez_arcsec[0],1e3\n");
  EXPECT_THAT(Succeed({"score", "run", "--against", "other.csv"}), HasSubstr("yours target      ez_arcsec"));
  Write("some.csv", "result,value,u\ntarget.ez_arcsec[0],1,0\ntarget.ez_arcsek[1],1,1\n");
  const std::string some = Succeed({"score", "run", "--against", "some.csv"});
  EXPECT_THAT(some, HasSubstr("no truth is known of target.ez_arcsek[1]\n"));
  EXPECT_THAT(some, HasSubstr("u is 0, so that (error/u)^2 leaves it out, of target.ez_arcsec[0]\n"));
  Write("none.csv", "result,value\ntarget.ez_arcsek[0],1\n");
  ExpectRefused({"score", "run", "--against", "none.csv"}, "target.ez_arcsec[0]");
  Write("bare.csv", "name,value\ntarget.ez_arcsec[0],1\n");
  ExpectRefused({"score", "run", "--against", "bare.csv"}, "bare.csv:1");
  Succeed({"import", "readings.csv", "--scenario", "small.toml", "-o", "imported"});
  ExpectRefused({"score", "imported"}, "imported/truth.json");
}

/// A schema of our own in the place of the PTB's: only that the root is there and whether it may be this version.
std::string SchemaFor(const std::string& version) {
  return R"(<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema" targetNamespace="https://ptb.de/dcc" elementFormDefault="qualified">
<xs:element name="digitalCalibrationCertificate"><xs:complexType>
<xs:sequence><xs:any minOccurs="0" maxOccurs="unbounded" processContents="skip"/></xs:sequence>
<xs:attribute name="schemaVersion" fixed=")" + version + R"("/></xs:complexType></xs:element></xs:schema>)";
}

class CertificateCommand : public Evaluate {
 protected:
  CertificateCommand() {
    BeginWith("certificate", [this] {
      Succeed({"certificate", "--template", "-o", "empty.toml"});
      std::string text = std::regex_replace(Read("empty.toml"), std::regex("country = \"\""), "country = \"DE\"");
      text = std::regex_replace(text, std::regex("(begin|end) = \"\""), "$1 = \"2026-02-28\"");
      Write("laboratory.toml", std::regex_replace(text, std::regex("\"\"(  # [^\n]*; needed)"), "\"something\"$1"));
    });
  }
};

TEST_F(CertificateCommand, StatesTheNumbersOfTheResultsAndThatTheyAreSimulated) {
  EXPECT_THAT(Succeed({"certificate", "run", "--with", "laboratory.toml", "-o", "c.xml"}), HasSubstr("SIMULATED"));
  const nlohmann::json told = Json({"certificate", "run", "--with", "laboratory.toml", "-o", "c.xml", "--force", "--json", "-"});
  EXPECT_TRUE(told.at("simulated"));
  EXPECT_FALSE(told.at("certified").empty());
  EXPECT_EQ(Call({"certificate", "run", "--with", "laboratory.toml", "--json", "-"}).exit_code, 2) << "both to stdout";
  const std::string xml = Read("c.xml");
  EXPECT_THAT(xml, HasSubstr("SIMULATED table under test, ez"));
  EXPECT_THAT(xml, HasSubstr("<dcc:traceable>false</dcc:traceable>"));
  const auto results = nlohmann::json::parse(Read("run/results.json"));
  EXPECT_THAT(xml, HasSubstr("<si:valueXMLList>" + results.at("separation").at("target").at("ez_arcsec").at(0).dump() + " "));
}

TEST_F(CertificateCommand, StatesBothTablesWhereTheShiftsTellThemApartAndNeitherWhereTheyDoNot) {
  Succeed({"new", "turntable_autocollimator", "-o", "sum.toml"});
  Succeed({"run", "sum.toml", "-o", "sum"});
  ExpectRefused({"certificate", "sum", "--with", "laboratory.toml"});
  Succeed({"run", TWINBENCH_SOURCE_DIR "/scenarios/turntable_shifts.toml", "-o", "apart"});
  const std::string xml = Succeed({"certificate", "apart", "--with", "laboratory.toml"});
  EXPECT_THAT(xml, HasSubstr("SIMULATED turntable, ez"));
  EXPECT_THAT(xml, HasSubstr("SIMULATED multi-tooth table, ez"));
  EXPECT_THAT(xml, HasSubstr("error motion, turntable, tilt_fixed_x, synchronous"));
}

TEST_F(CertificateCommand, IsWrittenOnlyIfItSatisfiesTheSchema) {
  for (const char* folder : {"good", "bad", "broken"}) std::filesystem::create_directory(At(folder));
  Write("good/dcc.xsd", SchemaFor("3.3.0"));
  Write("bad/dcc.xsd", SchemaFor("2.0.0"));
  Write("broken/dcc.xsd", "no schema");
  Succeed({"certificate", "run", "--with", "laboratory.toml", "--schema", "good", "-o", "c.xml"});
  EXPECT_TRUE(Exists("c.xml"));
  ExpectRefused({"certificate", "run", "--with", "laboratory.toml", "--schema", "none"});
  // Behind what xmllint says.
  for (const auto& [schema, said] : {std::pair{"bad", "does not satisfy bad/dcc.xsd; nothing was written"},
                                     std::pair{"broken", "could not read the schema"}}) {
    ExpectEnded(Call({"certificate", "run", "--with", "laboratory.toml", "--schema", schema, "-o", "d.xml"}), 2,
                {said});
    EXPECT_FALSE(Exists("d.xml"));
  }
}

TEST_F(CertificateCommand, SaysWhatIsMissingAndOverwritesNoInput) {
  ExpectRefused({"certificate", "run"}, "--with laboratory.toml");
  ExpectRefused({"certificate", "run", "--with", "empty.toml"}, "empty.toml: ");
  ExpectRefused({"certificate", "run", "--with", "laboratory.toml", "-o", "laboratory.toml"});
  ExpectRefused({"certificate", "nothing", "--with", "laboratory.toml"});
}

using ReportCommand = Evaluate;

TEST_F(ReportCommand, WritesPicturesWithoutABrowserAndTruthOnlyOfAScoredRun) {
  Succeed({"report", "run", "--svg", "pictures"});
  EXPECT_THAT(Read("pictures/errors-target-ez.svg"), Not(HasSubstr("truth")));
  Succeed({"score", "run", "--estimator", "published"});
  EXPECT_FALSE(Exists("run/score.json")) << "the page shows the other estimator's results";
  Succeed({"score", "run"});
  Succeed({"report", "run", "--svg", "pictures"});
  EXPECT_THAT(Read("pictures/errors-target-ez.svg"), HasSubstr("truth"));
  EXPECT_FALSE(Exists("run/report.html"));
}

TEST_F(ReportCommand, IsOneFileThatNamesNoOther) {
  if (web::PageMarkup().empty()) GTEST_SKIP() << "built without pages";
  EXPECT_THAT(Succeed({"report", "run"}), HasSubstr("run/report.html"));
  const std::string page = Read("run/report.html");
  Succeed({"report", "run"});  // a page takes the place of a page
  EXPECT_LT(page.size(), 3'000'000u);
  for (const char* other : {"<script src", "<link", "@import"}) EXPECT_EQ(page.find(other), std::string::npos) << other;
  EXPECT_NE(page.find("default-src 'none'; script-src 'sha256-"), std::string::npos);
}

TEST_F(ReportCommand, RefusesWhatNoPageIsMadeOfAndOverwritesNoInput) {
  Write("other.json", "{\"a\": 1}");
  Write("notes.html", "three weeks of work");
  Write("deep.json", "{\"steps\":" + std::string(100'000, '[') + std::string(100'000, ']') + "}");
  Write("damaged.json", "{\"runs\": [1], \"advice\": [2]}");
  Succeed({"score", "run"});  // of a run that was not, a line more is said
  ExpectRefused({"report", "nothing"});
  ExpectRefused({"report", "other.json", "--svg", "p"}, "other.json: ");
  ExpectRefused({"report", "run", "-o", "run/results.json"});
  ExpectRefused({"report", "run", "-o", "notes.html"}, "notes.html: ");
  ExpectRefused({"report", "deep.json"}, "deep.json: ");
  EXPECT_THAT(Refusal({"report", "damaged.json"}),
              HasSubstr("damaged.json: a result in it is not as it is written"));
}

}  // namespace
}  // namespace twinbench::test
