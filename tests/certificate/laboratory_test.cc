#include "twin/report/certificate/laboratory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "twin/core/errors.h"

namespace twinbench::certificate {
namespace {

/// The template with every needed key filled in.
std::string Filled() {
  std::string text = LaboratoryTemplate();
  text = std::regex_replace(text, std::regex("country = \"\""), "country = \"DE\"");
  text = std::regex_replace(text, std::regex("(begin|end) = \"\""), "$1 = \"2026-02-28\"");
  return std::regex_replace(text, std::regex("\"\"(  # [^\n]*; needed)"), "\"something\"$1");
}

std::string With(const std::string& from, const std::string& to) {
  const std::string text = Filled();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.substr(0, at) + to + text.substr(at + from.size());
}

std::string Complaint(const std::string& text) {
  try {
    ReadLaboratory(text, "laboratory.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Laboratory, TheTemplateNamesAllThatIsMissingAtOnce) {
  const std::string complaint = Complaint(LaboratoryTemplate());
  for (const char* key : {"certificate.identifier", "certificate.country", "certificate.begin", "laboratory.name", "laboratory.city", "person.name",
                          "customer.name", "customer.country", "item.name", "item.serial"})
    EXPECT_NE(complaint.find(key), std::string::npos) << key << " in " << complaint;
  EXPECT_EQ(complaint.find("item.model"), std::string::npos) << complaint;
}

TEST(Laboratory, AFilledTemplateIsRead) {
  const Laboratory laboratory = ReadLaboratory(Filled(), "laboratory.toml");
  EXPECT_EQ(laboratory.identifier, "something");
  EXPECT_EQ(laboratory.customer.country, "DE");
  EXPECT_EQ(laboratory.begin, "2026-02-28");
  EXPECT_TRUE(std::isnan(laboratory.temperature_degC));
  EXPECT_FALSE(laboratory.simulated);
}

TEST(Laboratory, SaysWhereADayOrACountryIsNone) {
  EXPECT_EQ(Complaint(With("begin = \"2026-02-28\"", "begin = \"2026-02-29\"")),
            "laboratory.toml:7: certificate.begin is \"2026-02-29\"; expected a day as YYYY-MM-DD");
  EXPECT_NE(Complaint(With("end = \"2026-02-28\"", "end = \"28.2.2026\"")).find("certificate.end is"), std::string::npos);
  EXPECT_NE(Complaint(With("end = \"2026-02-28\"", "end = \"2026-02-27\"")).find("ends before it begins"), std::string::npos);
  EXPECT_NE(Complaint(With("country = \"DE\"", "country = \"Germany\"")).find("laboratory.toml:5: certificate.country is"), std::string::npos);
}

TEST(Laboratory, RefusesATemperatureWithoutUncertaintyAndKeysNobodyKnows) {
  EXPECT_NE(Complaint(With("# temperature_degC", "temperature_degC")).find("a temperature without its uncertainty"), std::string::npos);
  EXPECT_NE(Complaint(With("serial =", "seriel =")).find("seriel"), std::string::npos);
}

}  // namespace
}  // namespace twinbench::certificate
