#include "twin/report/certificate/laboratory.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/toml_reader.h"

namespace twinbench::certificate {
namespace {

/// One key of the file; `needed`: a certificate cannot do without it.
struct LaboratoryKey {
  ScenarioKey key;
  bool needed;
};

class LaboratoryKeys {
 public:
  explicit LaboratoryKeys(Laboratory& l) {
    Table("certificate");
    Needed("identifier", l.identifier, "unique identifier of this certificate");
    Needed("country", l.country, "country of issue, two capital letters of ISO 3166-1");
    May("language", l.language, "language of your texts, two letters of ISO 639-1; all others are English");
    Needed("begin", l.begin, "first day of the calibration, YYYY-MM-DD");
    Needed("end", l.end, "last day of the calibration, YYYY-MM-DD");
    May("issued", l.issued, "day of issue, YYYY-MM-DD; ISO/IEC 17025 asks for it");
    May("location", l.location, "where it was carried out", {"laboratory", "customer", "laboratoryBranch", "customerBranch", "other"});
    Add("simulated", &l.simulated, "true: the readings are a simulation's; a run of the twin is known to be one without", false);
    AddContact("laboratory", l.laboratory, "calibration laboratory");
    May("accreditation", l.accreditation, "code under which the laboratory is accredited");
    Table("person");
    Needed("name", l.person, "person who answers for the certificate");
    May("role", l.role, "of that person");
    AddContact("customer", l.customer, "customer");
    Table("item");
    Needed("name", l.item, "what was calibrated");
    May("manufacturer", l.manufacturer, "who made it");
    May("model", l.model, "its type");
    Needed("serial", l.serial, "number that identifies it");
    May("description", l.description, "more about it");
    Table("conditions");
    Add("temperature", &l.temperature_degC, "temperature during the calibration; left out: that of the readings", false, {"degC", 1.0});
    keys_.back().key.bounds = {-50.0, 100.0};
    Add("expanded_uncertainty", &l.expanded_temperature_degC, "of the temperature, for about 95 %", false, {"degC", 1.0});
    keys_.back().key.bounds = {0.0, 50.0, true};
    Table("traceability");
    May("statement", l.traceability, "to which standards the results are traceable; needed unless simulated");
  }

  std::vector<ScenarioKey> ToRead() const {
    std::vector<ScenarioKey> keys;
    for (const LaboratoryKey& one : keys_) keys.push_back(one.key);
    return keys;
  }
  const std::vector<LaboratoryKey>& all() const { return keys_; }

 private:
  void Table(const char* table) { table_ = table; }
  void Add(const char* name, Field field, const std::string& meaning, bool needed, Unit unit = {}) {
    keys_.push_back({{table_, name, unit, {}, {}, field, meaning}, needed});
  }
  void Needed(const char* name, std::string& text, const std::string& meaning) { Add(name, &text, meaning, true); }
  void May(const char* name, std::string& text, const std::string& meaning, std::vector<std::string> choices = {}) {
    Add(name, &text, meaning, false);
    keys_.back().key.choices = std::move(choices);
  }
  void AddContact(const char* table, Contact& contact, const std::string& who) {
    Table(table);
    Needed("name", contact.name, "name of the " + who);
    May("street", contact.street, "its street");
    May("street_no", contact.street_no, "number in the street");
    May("post_code", contact.post_code, "its post code");
    Needed("city", contact.city, "its city");
    Needed("country", contact.country, "its country, two capital letters of ISO 3166-1");
    May("email", contact.email, "its address for mail");
  }

  std::string table_;
  std::vector<LaboratoryKey> keys_;
};

bool IsEmpty(const ScenarioKey& key) {
  const auto* text = std::get_if<std::string*>(&key.field);
  return text && (*text)->find_first_not_of(" \t\r\n") == std::string::npos;
}

void RequireAll(const std::vector<LaboratoryKey>& keys, const std::string& name) {
  std::string missing;
  for (const auto& [key, needed] : keys) {
    if (needed && IsEmpty(key)) missing += (missing.empty() ? "" : ", ") + key.Path();
  }
  if (!missing.empty()) throw InputError(name, "there is no " + missing, "every key that `twinbench certificate --template` calls needed");
}

std::string PlaceOf(const KeyPlaces& places, const std::string& path, const std::string& name) {
  const auto place = places.find(path);
  return place == places.end() ? name : place->second;
}

bool AllWithin(const std::string& text, char from, char to) {
  return std::ranges::all_of(text, [=](char c) { return c >= from && c <= to; });
}

bool IsDate(const std::string& text) {
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return false;
  const std::string digits = text.substr(0, 4) + text.substr(5, 2) + text.substr(8, 2);
  if (!AllWithin(digits, '0', '9')) return false;
  const int ymd = std::stoi(digits);
  using namespace std::chrono;
  return year_month_day{year{ymd / 10000}, month(static_cast<unsigned>(ymd / 100 % 100)), day(static_cast<unsigned>(ymd % 100))}.ok();
}

struct CheckedText {
  const char* path;
  const std::string& text;
};

void CheckDates(const Laboratory& l, const KeyPlaces& places, const std::string& name) {
  for (const auto& [path, text] : {CheckedText{"certificate.begin", l.begin}, {"certificate.end", l.end}, {"certificate.issued", l.issued}}) {
    if (!text.empty() && !IsDate(text))
      throw InputError(PlaceOf(places, path, name), fmt::format("{} is \"{}\"", path, text), "a day as YYYY-MM-DD");
  }
  // Days written like this are ordered as texts are.
  if (l.end < l.begin)
    throw InputError(PlaceOf(places, "certificate.end", name), "the calibration ends before it begins", "certificate.end from " + l.begin + " on");
  if (!l.issued.empty() && l.issued < l.end)
    throw InputError(PlaceOf(places, "certificate.issued", name), "the certificate is issued before the calibration ends",
                     "certificate.issued from " + l.end + " on");
}

void CheckCodes(const Laboratory& l, const KeyPlaces& places, const std::string& name) {
  for (const auto& [path, text] :
       {CheckedText{"certificate.country", l.country}, {"laboratory.country", l.laboratory.country}, {"customer.country", l.customer.country}}) {
    if (text.size() != 2 || !AllWithin(text, 'A', 'Z'))
      throw InputError(PlaceOf(places, path, name), fmt::format("{} is \"{}\"", path, text), "two capital letters, as \"DE\"");
  }
  if (l.language.size() != 2 || !AllWithin(l.language, 'a', 'z'))
    throw InputError(PlaceOf(places, "certificate.language", name), fmt::format("certificate.language is \"{}\"", l.language),
                     "two small letters, as \"en\"");
}

void CheckTemperature(const Laboratory& l, const KeyPlaces& places, const std::string& name) {
  if (std::isfinite(l.temperature_degC) && !std::isfinite(l.expanded_temperature_degC))
    throw InputError(PlaceOf(places, "conditions.temperature_degC", name), "a temperature without its uncertainty",
                     "conditions.expanded_uncertainty_degC too");
}

std::string DefaultText(const ScenarioKey& key) {
  if (const auto* text = std::get_if<std::string*>(&key.field)) return "\"" + **text + "\"";
  if (std::holds_alternative<bool*>(key.field)) return "false";
  return "";
}

std::string TemplateLine(const ScenarioKey& key, bool needed) {
  const std::string meaning = key.meaning + (needed ? "; needed" : "");
  const std::string value = DefaultText(key);
  // A number that is left out has no text that stands for it.
  if (value.empty()) return fmt::format("# {} = {}  # {}\n", key.Name(), key.bounds.above_lower ? "0.1" : "20.0", meaning);
  return fmt::format("{} = {}  # {}\n", key.Name(), value, meaning);
}

}  // namespace

Laboratory ReadLaboratory(const std::string& text, const std::string& name) {
  Laboratory laboratory;
  const LaboratoryKeys keys(laboratory);
  const KeyPlaces places = ReadToml(text, name, keys.ToRead());
  RequireAll(keys.all(), name);
  CheckDates(laboratory, places, name);
  CheckCodes(laboratory, places, name);
  CheckTemperature(laboratory, places, name);
  return laboratory;
}

std::string LaboratoryTemplate() {
  Laboratory laboratory;
  std::string text = "# What only the laboratory knows: twinbench certificate RUN --with this-file -o certificate.xml\n", table;
  const LaboratoryKeys keys(laboratory);
  for (const auto& [key, needed] : keys.all()) {
    if (key.table != table) text += fmt::format("\n[{}]\n", key.table);
    table = key.table;
    text += TemplateLine(key, needed);
  }
  return text;
}

}  // namespace twinbench::certificate
