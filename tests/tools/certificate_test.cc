
#include <regex>

#include "tests/tools/program_here.h"
#include "tools/web/bundle.h"

namespace twinbench::test {
namespace {

using ::testing::HasSubstr;

/// A schema of our own in the place of the PTB's: only that the root is there and whether it may be this version.
std::string SchemaFor(const std::string& version) {
  return R"(<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema" targetNamespace="https://ptb.de/dcc" elementFormDefault="qualified">
<xs:element name="digitalCalibrationCertificate"><xs:complexType>
<xs:sequence><xs:any minOccurs="0" maxOccurs="unbounded" processContents="skip"/></xs:sequence>
<xs:attribute name="schemaVersion" fixed=")" + version + R"("/></xs:complexType></xs:element></xs:schema>)";
}

class CertificateCommand : public ProgramHere {
 protected:
  CertificateCommand() {
    BeginWith("certificate", [this] {
      Write("small.toml", kSmall);
      MakeRun("run");
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
    const Outcome outcome =
        Call({"certificate", "run", "--with", "laboratory.toml", "--schema", schema, "-o", "d.xml"});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(said));
    EXPECT_FALSE(Exists("d.xml"));
  }
}

TEST_F(CertificateCommand, SaysWhatIsMissingAndOverwritesNoInput) {
  ExpectRefused({"certificate", "run"}, "--with laboratory.toml");
  ExpectRefused({"certificate", "run", "--with", "empty.toml"}, "empty.toml: ");
  ExpectRefused({"certificate", "run", "--with", "laboratory.toml", "-o", "laboratory.toml"});
  ExpectRefused({"certificate", "nothing", "--with", "laboratory.toml"});
}

using ::testing::Not;

class ReportCommand : public ProgramHere {
 protected:
  ReportCommand() {
    BeginWith("report", [this] {
      Write("small.toml", kSmall);
      MakeRun("run");
    });
  }
};

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
