#include "twin/report/certificate/certificate_xml.h"

#include <fstream>
#include <pugixml.hpp>

#include "twin/report/certificate/xml_text.h"

namespace twinbench::certificate {
namespace {

constexpr const char* kMarkup = "a]]><script>alert(1)</script>&amp;\"'\x01 <!-- é";

/// Values that no short text holds.
CertificateContent Content() {
  CertificateContent content;
  Laboratory& lab = content.laboratory;
  lab.identifier = "C-1", lab.country = "DE", lab.begin = lab.end = "2026-11-25", lab.issued = "2026-11-26";
  lab.laboratory = {"Laboratory", "Street", "1 a", "12345", "Town", "DE", "mail@example.org"};
  lab.customer = {"Customer", "", "", "", "Village", "FR", ""};
  lab.person = "A. Person", lab.role = "head", lab.item = "rotary table", lab.manufacturer = "Maker", lab.model = "T1", lab.serial = "4711";
  lab.accreditation = "D-K-0", lab.traceability = "to the standard of angle";
  content.certified.quantities = {
      {"table, ez", "", "ISO 1", "arcsec", "\\arcsecond", {1.0 / 3.0, -2e-7, 3e21}, {0.1, 1.0 / 7.0, 0.3}, 1.9611508260994375, false, {{"position", "\\degree", {0.0, 0.1, 240.5}}}},
      {"backlash", "", "", "um", "\\micro\\metre", {0.18437}, {0.03126}, 1.959963984540054, true, {}}};
  content.certified.left_out = {{"reference dz", "no detector reads it"}};
  content.method = "method", content.run = "first", content.scenario_title = kMarkup, content.readings_from = "hardware: card";
  content.recorded_by = content.program_version = "0.1.0";
  content.temperature = {20.0625, 0.25, "as stated"};
  content.digests = {{"results.json", "abc"}};
  return content;
}

pugi::xml_document Parsed(const std::string& xml) {
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_string(xml.c_str());
  EXPECT_TRUE(result) << result.description();
  return document;
}

/// Names of the children, one after another.
std::string ChildrenOf(const pugi::xml_document& document, const std::string& path) {
  const pugi::xml_node node = document.first_element_by_path(("dcc:digitalCalibrationCertificate/" + path).c_str());
  EXPECT_TRUE(node) << path;
  std::string names;
  for (const pugi::xml_node child : node.children()) names += (names.empty() ? "" : " ") + std::string(child.name());
  return names;
}

std::string TextAt(const pugi::xml_document& document, const char* xpath) {
  const pugi::xpath_node found = document.select_node(xpath);
  EXPECT_TRUE(found) << xpath;
  return found.node().text().get();
}

std::vector<double> NumbersIn(const pugi::xml_document& document, const char* xpath) {
  std::istringstream text(TextAt(document, xpath));
  std::vector<double> numbers;
  for (std::string word; text >> word;) numbers.push_back(std::strtod(word.c_str(), nullptr));
  return numbers;
}

/// The sequences of dcc.xsd 3.3.0 and SI_Format.xsd 2.2, of which an element may be missing where it need not be there.
TEST(CertificateXml, HasTheChildrenInTheOrderOfTheSchema) {
  const pugi::xml_document document = Parsed(CertificateXml(Content()));
  const std::string root = "dcc:digitalCalibrationCertificate", result = "dcc:measurementResults/dcc:measurementResult";
  const std::array<std::array<std::string, 2>, 15> expected = {{
      {".", "dcc:administrativeData dcc:measurementResults dcc:comment"},
      {"dcc:administrativeData", "dcc:dccSoftware dcc:coreData dcc:items dcc:calibrationLaboratory dcc:respPersons dcc:customer dcc:statements"},
      {"dcc:administrativeData/dcc:dccSoftware/dcc:software", "dcc:name dcc:release dcc:description"},
      {"dcc:administrativeData/dcc:coreData",
       "dcc:countryCodeISO3166_1 dcc:usedLangCodeISO639_1 dcc:mandatoryLangCodeISO639_1 dcc:uniqueIdentifier dcc:beginPerformanceDate "
       "dcc:endPerformanceDate dcc:performanceLocation dcc:issueDate"},
      {"dcc:administrativeData/dcc:items/dcc:item", "dcc:name dcc:manufacturer dcc:model dcc:identifications"},
      {"dcc:administrativeData/dcc:calibrationLaboratory", "dcc:calibrationLaboratoryCode dcc:contact"},
      {"dcc:administrativeData/dcc:calibrationLaboratory/dcc:contact", "dcc:name dcc:eMail dcc:location"},
      {"dcc:administrativeData/dcc:respPersons/dcc:respPerson", "dcc:person dcc:role dcc:mainSigner"},
      {"dcc:administrativeData/dcc:statements/dcc:statement", "dcc:name dcc:traceable dcc:declaration"},
      {result, "dcc:name dcc:description dcc:usedMethods dcc:usedSoftware dcc:influenceConditions dcc:results"},
      {result + "/dcc:usedMethods/dcc:usedMethod", "dcc:name dcc:description dcc:norm"},
      {result + "/dcc:influenceConditions/dcc:influenceCondition", "dcc:name dcc:description dcc:data"},
      {result + "/dcc:results/dcc:result", "dcc:name dcc:description dcc:data"},
      {result + "/dcc:results/dcc:result/dcc:data/dcc:list", "dcc:quantity dcc:quantity"},
      {result + "/dcc:results/dcc:result/dcc:data/dcc:list/dcc:quantity", "dcc:name si:realListXMLList"},
  }};
  for (const auto& [path, children] : expected) EXPECT_EQ(ChildrenOf(document, path), children) << path;
  const auto root_node = document.child(root.c_str());
  EXPECT_STREQ(root_node.attribute("schemaVersion").value(), "3.3.0");
  EXPECT_STREQ(root_node.attribute("xmlns:dcc").value(), "https://ptb.de/dcc");
  EXPECT_STREQ(root_node.attribute("xmlns:si").value(), "https://ptb.de/si");
}

TEST(CertificateXml, HoldsEveryNumberBitForBit) {
  const CertificateContent content = Content();
  const pugi::xml_document document = Parsed(CertificateXml(content));
  const CertifiedQuantity& list = content.certified.quantities[0];
  EXPECT_EQ(NumbersIn(document, "//dcc:list/dcc:quantity[1]//si:valueXMLList"), list.where[0].values);
  EXPECT_EQ(NumbersIn(document, "//dcc:list/dcc:quantity[2]//si:valueXMLList"), list.values);
  EXPECT_EQ(NumbersIn(document, "//si:valueExpandedMUXMLList"), list.expanded);
  EXPECT_EQ(NumbersIn(document, "//si:coverageFactorXMLList"), std::vector{list.coverage_factor});
  EXPECT_EQ(NumbersIn(document, "//si:coverageProbabilityXMLList"), std::vector{0.95});
  EXPECT_EQ(TextAt(document, "//si:distributionXMLList"), "studentT");
  EXPECT_EQ(NumbersIn(document, "//dcc:result[2]//si:real/si:value"), std::vector{0.18437});
  EXPECT_EQ(NumbersIn(document, "//dcc:result[2]//si:valueExpandedMU"), std::vector{0.03126});
  EXPECT_EQ(TextAt(document, "//dcc:result[2]//si:unit"), "\\micro\\metre");
  EXPECT_EQ(NumbersIn(document, "//dcc:influenceCondition//si:value"), std::vector{20.0625});
}

/// GUM 7.2.6: two digits of the uncertainty, and the value to the same place.
TEST(CertificateXml, RoundsWhatIsForPeopleOnly) {
  const pugi::xml_document document = Parsed(CertificateXml(Content()));
  EXPECT_EQ(TextAt(document, "//dcc:result[2]/dcc:description/dcc:content"), "(0.184 ± 0.031) um, k = 1.96, 95 %");
}

TEST(CertificateXml, TakesMarkupOfAScenarioAsText) {
  const pugi::xml_document document = Parsed(CertificateXml(Content()));
  EXPECT_EQ(TextAt(document, "//dcc:measurementResult/dcc:description/dcc:content"), "a]]><script>alert(1)</script>&amp;\"'  <!-- é");
  EXPECT_FALSE(document.select_node("//script"));
}

TEST(CertificateXml, TakesBytesThatAreNoTextAsQuestionMarks) {
  EXPECT_EQ(XmlText(" caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80\n"), "caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80");
  EXPECT_EQ(XmlText("a\xFF\x80z"), "a??z");          // no first byte
  EXPECT_EQ(XmlText("\xE2\x82"), "??");              // cut off
  EXPECT_EQ(XmlText("\xC0\xAF"), "??");              // "/" written too long
  EXPECT_EQ(XmlText("\xED\xA0\x80"), "???");         // half of a surrogate pair
  EXPECT_EQ(XmlText("\xEF\xBF\xBF\x1B"), "???");      // U+FFFF; a control character
}

TEST(CertificateXml, RepeatsWhatADiagnosisHasFound) {
  CertificateContent content = Content();
  content.diagnosis = "Cause identified: drift";
  EXPECT_EQ(TextAt(Parsed(CertificateXml(content)), "//dcc:statement[3]/dcc:declaration/dcc:content"), "Cause identified: drift");
}

TEST(CertificateXml, SaysWhatIsSimulatedInEveryPlaceAndClaimsNoTraceability) {
  CertificateContent content = Content();
  EXPECT_EQ(CertificateXml(content).find("SIMULATED"), std::string::npos);
  EXPECT_EQ(TextAt(Parsed(CertificateXml(content)), "//dcc:traceable"), "true");
  content.simulated = true;
  const std::string xml = CertificateXml(content);
  const pugi::xml_document document = Parsed(xml);
  EXPECT_EQ(TextAt(document, "//dcc:traceable"), "false");
  EXPECT_EQ(xml.find("to the standard of angle"), std::string::npos);
  for (const char* xpath : {"//dcc:measurementResult/dcc:name/dcc:content", "//dcc:comment/dcc:content", "//dcc:item/dcc:name/dcc:content",
                            "//dcc:result[1]/dcc:name/dcc:content", "//dcc:result[2]/dcc:name/dcc:content", "//dcc:result[2]//dcc:quantity/dcc:name/dcc:content"})
    EXPECT_EQ(TextAt(document, xpath).rfind("SIMULATED", 0), 0u) << xpath;
}

TEST(CertificateXml, NamesWhatIsNotCertified) {
  const pugi::xml_document document = Parsed(CertificateXml(Content()));
  EXPECT_EQ(TextAt(document, "//dcc:statement[3]/dcc:name/dcc:content"), "not certified: reference dz");
  EXPECT_EQ(TextAt(document, "//dcc:statement[3]/dcc:declaration/dcc:content"), "no detector reads it");
}

/// What the program says is English, whatever the laboratory writes in.
TEST(CertificateXml, LabelsOnlyTheLaboratorysTextsWithItsLanguage) {
  CertificateContent content = Content();
  content.laboratory.language = "de";
  const pugi::xml_document document = Parsed(CertificateXml(content));
  for (const char* xpath : {"//dcc:item/dcc:name", "//dcc:customer/dcc:name", "//dcc:statement[1]/dcc:declaration"})
    EXPECT_EQ(TextAt(document, (std::string(xpath) + "/dcc:content[@lang='de']").c_str()), TextAt(document, (std::string(xpath) + "/dcc:content").c_str()));
  for (const char* xpath : {"//dcc:statement[2]/dcc:declaration", "//dcc:result[1]/dcc:name", "//dcc:usedMethod/dcc:description"})
    EXPECT_FALSE(document.select_node((std::string(xpath) + "/dcc:content[@lang='de']").c_str())) << xpath;
  EXPECT_EQ(document.select_nodes("//dcc:usedLangCodeISO639_1").size(), 2U);
  EXPECT_EQ(TextAt(document, "//dcc:mandatoryLangCodeISO639_1"), "en");
}

TEST(CertificateXml, SaysThatTheResultsRelateToTheItemOnlyWhereThereIsOne) {
  CertificateContent content = Content();
  EXPECT_NE(CertificateXml(content).find("The results relate only to the item"), std::string::npos);
  content.simulated = true;
  EXPECT_EQ(CertificateXml(content).find("The results relate only to the item"), std::string::npos);
}

TEST(CertificateXml, IsWellFormedForXmllint) {
  const std::string path = testing::TempDir() + "certificate_well_formed.xml";
  std::ofstream(path) << CertificateXml(Content());
  EXPECT_EQ(std::system(("xmllint --nonet --noout '" + path + "'").c_str()), 0);
}

}  // namespace
}  // namespace twinbench::certificate
