#include "twin/report/certificate/certificate_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <sstream>

#include "twin/report/certificate/xml_text.h"
#include "twin/report/page/named_numbers.h"

namespace twinbench::certificate {
namespace {

using pugi::xml_node;

constexpr const char* kSimulated =
    "SIMULATED: the readings are those of a simulation. No item was calibrated, and the values are not traceable to any standard.";

/// ISO/IEC 17025:2017, 7.8.2.1 l.
constexpr const char* kOfTheItem = "The results relate only to the item that was calibrated, at the time and under the conditions stated.";

constexpr const char* kLanguage = "en";  // of all texts but the laboratory's own

/// Elements of one certificate.
class Writer {
 public:
  explicit Writer(const CertificateContent& content) : content_(content), lab_(content.laboratory) {}

  std::string Text() {
    xml_node declaration = document_.append_child(pugi::node_declaration);
    declaration.append_attribute("version").set_value("1.0");
    declaration.append_attribute("encoding").set_value("UTF-8");
    xml_node root = document_.append_child("dcc:digitalCalibrationCertificate");
    root.append_attribute("xmlns:dcc").set_value("https://ptb.de/dcc");
    root.append_attribute("xmlns:si").set_value("https://ptb.de/si");
    root.append_attribute("xmlns:xsi").set_value("http://www.w3.org/2001/XMLSchema-instance");
    root.append_attribute("xsi:schemaLocation").set_value("https://ptb.de/dcc https://ptb.de/dcc/v3.3.0/dcc.xsd");
    root.append_attribute("schemaVersion").set_value("3.3.0");
    AddAdministrativeData(root.append_child("dcc:administrativeData"));
    AddMeasurementResult(root.append_child("dcc:measurementResults").append_child("dcc:measurementResult"));
    AddContent(root.append_child("dcc:comment"), Comment());
    std::ostringstream text;
    document_.save(text, "  ", pugi::format_indent, pugi::encoding_utf8);
    return text.str();
  }

 private:
  static void Put(xml_node parent, const char* name, const std::string& text) {
    if (const std::string clean = XmlText(text); !clean.empty()) parent.append_child(name).text().set(clean.c_str());
  }
  /// A text that may stand in several languages; each here stands in one.
  static void AddContent(xml_node node, const std::string& text, const std::string& language = kLanguage) {
    xml_node content = node.append_child("dcc:content");
    content.append_attribute("lang").set_value(language.c_str());
    content.text().set(XmlText(text).c_str());
  }
  static void AddText(xml_node parent, const char* name, const std::string& text) {
    if (!XmlText(text).empty()) AddContent(parent.append_child(name), text);
  }
  /// In the words of the laboratory's file.
  void AddOwn(xml_node parent, const char* name, const std::string& text) const {
    if (!XmlText(text).empty()) AddContent(parent.append_child(name), text, lab_.language);
  }

  // Who and what ------------------------------------------------------------------------------------------------------

  void AddAdministrativeData(xml_node node) const {
    AddSoftware(node.append_child("dcc:dccSoftware").append_child("dcc:software"), content_.program_version,
                "wrote this certificate from the results of the run " + content_.run + Digests());
    AddCoreData(node.append_child("dcc:coreData"));
    AddItem(node.append_child("dcc:items").append_child("dcc:item"));
    xml_node laboratory = node.append_child("dcc:calibrationLaboratory");
    Put(laboratory, "dcc:calibrationLaboratoryCode", lab_.accreditation);
    AddContact(laboratory.append_child("dcc:contact"), lab_.laboratory);
    AddPerson(node.append_child("dcc:respPersons").append_child("dcc:respPerson"));
    AddContact(node.append_child("dcc:customer"), lab_.customer);
    AddStatements(node.append_child("dcc:statements"));
  }

  std::string Digests() const {
    std::string text;
    for (const auto& [file, digest] : content_.digests) text += fmt::format("; SHA-256 of {}: {}", file, digest);
    return text;
  }

  void AddSoftware(xml_node node, const std::string& release, const std::string& description) const {
    AddText(node, "dcc:name", "twinbench");
    Put(node, "dcc:release", release.empty() ? "unknown" : release);
    AddText(node, "dcc:description", description);
  }

  void AddCoreData(xml_node node) const {
    Put(node, "dcc:countryCodeISO3166_1", lab_.country);
    Put(node, "dcc:usedLangCodeISO639_1", kLanguage);
    if (lab_.language != kLanguage) Put(node, "dcc:usedLangCodeISO639_1", lab_.language);
    Put(node, "dcc:mandatoryLangCodeISO639_1", kLanguage);
    Put(node, "dcc:uniqueIdentifier", lab_.identifier);
    Put(node, "dcc:beginPerformanceDate", lab_.begin);
    Put(node, "dcc:endPerformanceDate", lab_.end);
    Put(node, "dcc:performanceLocation", lab_.location);
    Put(node, "dcc:issueDate", lab_.issued);
  }

  void AddItem(xml_node node) const {
    AddOwn(node, "dcc:name", Marked(lab_.item));
    AddOwn(node, "dcc:description", lab_.description);
    if (!lab_.manufacturer.empty()) AddOwn(node.append_child("dcc:manufacturer"), "dcc:name", lab_.manufacturer);
    Put(node, "dcc:model", lab_.model);
    xml_node identification = node.append_child("dcc:identifications").append_child("dcc:identification");
    Put(identification, "dcc:issuer", "manufacturer");
    Put(identification, "dcc:value", lab_.serial);
  }

  void AddContact(xml_node node, const Contact& contact) const {
    AddOwn(node, "dcc:name", contact.name);
    Put(node, "dcc:eMail", contact.email);
    xml_node location = node.append_child("dcc:location");
    Put(location, "dcc:city", contact.city);
    Put(location, "dcc:countryCode", contact.country);
    Put(location, "dcc:postCode", contact.post_code);
    Put(location, "dcc:street", contact.street);
    Put(location, "dcc:streetNo", contact.street_no);
  }

  void AddPerson(xml_node node) const {
    AddOwn(node.append_child("dcc:person"), "dcc:name", lab_.person);
    Put(node, "dcc:role", lab_.role);
    Put(node, "dcc:mainSigner", "true");
  }

  static void AddStatement(xml_node statements, const std::string& name, const std::string& declaration) {
    xml_node node = statements.append_child("dcc:statement");
    AddText(node, "dcc:name", name);
    AddText(node, "dcc:declaration", declaration);
  }

  void AddTraceability(xml_node node) const {
    AddText(node, "dcc:name", "traceability");
    Put(node, "dcc:traceable", content_.simulated ? "false" : "true");
    if (content_.simulated) return AddText(node, "dcc:declaration", kSimulated);
    AddOwn(node, "dcc:declaration", lab_.traceability);
  }

  void AddStatements(xml_node node) const {
    AddTraceability(node.append_child("dcc:statement"));
    AddStatement(node, "uncertainty",
                 "The uncertainties are expanded ones: standard uncertainties after JCGM 100:2008 (GUM) times the coverage factor stated beside them, for "
                 "a coverage probability of 95 %.");
    if (!content_.diagnosis.empty()) AddStatement(node, "diagnosis of the readings", content_.diagnosis);
    for (const auto& [what, why] : content_.certified.left_out) AddStatement(node, "not certified: " + what, why.empty() ? "not separable" : why);
    if (!content_.simulated) AddStatement(node, "scope of the results", kOfTheItem);
  }

  // Results ------------------------------------------------------------------------------------------------------------

  std::string Marked(const std::string& text) const { return content_.simulated ? "SIMULATED " + text : text; }

  void AddMeasurementResult(xml_node node) const {
    AddText(node, "dcc:name", content_.simulated ? "SIMULATED calibration, no real item" : "Calibration");
    AddOwn(node, "dcc:description", content_.scenario_title);
    AddMethods(node.append_child("dcc:usedMethods"));
    AddSoftware(node.append_child("dcc:usedSoftware").append_child("dcc:software"), content_.recorded_by,
                "recorded the readings from: " + content_.readings_from);
    AddTemperature(node.append_child("dcc:influenceConditions").append_child("dcc:influenceCondition"));
    xml_node results = node.append_child("dcc:results");
    for (const CertifiedQuantity& quantity : content_.certified.quantities) AddResult(results.append_child("dcc:result"), quantity);
  }

  void AddMethods(xml_node node) const {
    xml_node method = node.append_child("dcc:usedMethod");
    AddText(method, "dcc:name", Marked("measurement"));
    AddText(method, "dcc:description", content_.method);
    std::vector<std::string> norms;
    for (const CertifiedQuantity& quantity : content_.certified.quantities) {
      if (!quantity.norm.empty() && std::ranges::find(norms, quantity.norm) == norms.end()) norms.push_back(quantity.norm);
    }
    for (const std::string& norm : norms) Put(method, "dcc:norm", norm);
  }

  void AddTemperature(xml_node node) const {
    AddText(node, "dcc:name", "temperature");
    AddText(node, "dcc:description", content_.temperature.remark);
    xml_node quantity = node.append_child("dcc:data").append_child("dcc:quantity");
    xml_node real = quantity.append_child("si:real");
    Put(real, "si:value", XmlNumbers({content_.temperature.value_degC}));
    Put(real, "si:unit", "\\degreecelsius");
    if (content_.temperature.expanded_degC > 0.0) AddExpanded(real, content_.temperature.expanded_degC, 2.0, "normal");
  }

  void AddExpanded(xml_node real, double expanded, double k, const char* distribution) const {
    xml_node node = real.append_child("si:measurementUncertaintyUnivariate").append_child("si:expandedMU");
    Put(node, "si:valueExpandedMU", XmlNumbers({expanded}));
    Put(node, "si:coverageFactor", XmlNumbers({k}));
    Put(node, "si:coverageProbability", "0.95");
    Put(node, "si:distribution", distribution);
  }

  /// For people: rounded to two digits of the uncertainty.
  static std::string Spoken(const CertifiedQuantity& quantity) {
    const double largest = *std::ranges::max_element(quantity.expanded);
    const std::string unit = quantity.unit.empty() || quantity.unit == "1" ? "" : " " + quantity.unit;
    const std::string u = report::NumberText(largest, largest);
    const std::string text = quantity.where.empty()
                                 ? fmt::format("({} ± {}){}", report::NumberText(quantity.values.front(), largest), u, unit)
                                 : fmt::format("{} values, expanded uncertainty at most {}{}", quantity.values.size(), u, unit);
    return fmt::format("{}, k = {:.2f}, 95 %", text, quantity.coverage_factor);
  }

  void AddResult(xml_node node, const CertifiedQuantity& quantity) const {
    AddText(node, "dcc:name", Marked(quantity.title));
    AddText(node, "dcc:description", Spoken(quantity) + (quantity.note.empty() ? "" : "; " + quantity.note));
    xml_node data = node.append_child("dcc:data");
    if (quantity.where.empty()) return AddOne(data.append_child("dcc:quantity"), quantity);
    xml_node list = data.append_child("dcc:list");
    for (const Abscissa& abscissa : quantity.where) AddAbscissa(list.append_child("dcc:quantity"), abscissa);
    AddList(list.append_child("dcc:quantity"), quantity);
  }

  static const char* DistributionOf(const CertifiedQuantity& quantity) { return quantity.is_normal ? "normal" : "studentT"; }

  void AddOne(xml_node node, const CertifiedQuantity& quantity) const {
    AddText(node, "dcc:name", Marked(quantity.title));
    xml_node real = node.append_child("si:real");
    Put(real, "si:value", XmlNumbers(quantity.values));
    Put(real, "si:unit", quantity.dsi_unit);
    AddExpanded(real, quantity.expanded.front(), quantity.coverage_factor, DistributionOf(quantity));
  }

  void AddAbscissa(xml_node node, const Abscissa& abscissa) const {
    AddText(node, "dcc:name", abscissa.name);
    xml_node list = node.append_child("si:realListXMLList");
    Put(list, "si:valueXMLList", XmlNumbers(abscissa.values));
    Put(list, "si:unitXMLList", abscissa.dsi_unit);
  }

  /// What is the same for all of a list stands once (D-SI: one entry holds for all).
  void AddList(xml_node node, const CertifiedQuantity& quantity) const {
    AddText(node, "dcc:name", Marked(quantity.title));
    xml_node list = node.append_child("si:realListXMLList");
    Put(list, "si:valueXMLList", XmlNumbers(quantity.values));
    Put(list, "si:unitXMLList", quantity.dsi_unit);
    xml_node expanded = list.append_child("si:measurementUncertaintyUnivariateXMLList").append_child("si:expandedMUXMLList");
    Put(expanded, "si:valueExpandedMUXMLList", XmlNumbers(quantity.expanded));
    Put(expanded, "si:coverageFactorXMLList", XmlNumbers({quantity.coverage_factor}));
    Put(expanded, "si:coverageProbabilityXMLList", "0.95");
    Put(expanded, "si:distributionXMLList", DistributionOf(quantity));
  }

  std::string Comment() const {
    if (content_.simulated) return kSimulated;
    return "The readings come from: " + content_.readings_from + ". The certificate is not signed; a signature or seal is the laboratory's to add.";
  }

  const CertificateContent& content_;
  const Laboratory& lab_;
  pugi::xml_document document_;
};

}  // namespace

std::string CertificateXml(const CertificateContent& content) {
  return Writer(content).Text();
}

}  // namespace twinbench::certificate
