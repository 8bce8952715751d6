#include "twin/report/certificate/laboratory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"

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
  return MessageOf([&] { ReadLaboratory(text, "laboratory.toml"); });
}

TEST(Laboratory, TheTemplateNamesAllThatIsMissingAtOnce) {
  EXPECT_KEPT(Complaint(LaboratoryTemplate()));
}

TEST(Laboratory, AFilledTemplateIsRead) {
  const Laboratory laboratory = ReadLaboratory(Filled(), "laboratory.toml");
  EXPECT_EQ(laboratory.identifier, "something");
  EXPECT_EQ(laboratory.customer.country, "DE");
  EXPECT_EQ(laboratory.begin, "2026-02-28");
  EXPECT_TRUE(std::isnan(laboratory.temperature_degC));
  EXPECT_FALSE(laboratory.simulated);
}

TEST(Laboratory, SaysWhereADayACountryATemperatureOrAKeyIsNone) {
  const std::pair<const char*, const char*> cases[] = {
      {"begin = \"2026-02-28\"", "begin = \"2026-02-29\""}, {"end = \"2026-02-28\"", "end = \"28.2.2026\""},
      {"end = \"2026-02-28\"", "end = \"2026-02-27\""},     {"country = \"DE\"", "country = \"Germany\""},
      {"# temperature_degC", "temperature_degC"},           {"serial =", "seriel ="}};
  for (const auto& [from, to] : cases) {
    EXPECT_EQ(Complaint(With(from, to)).rfind("laboratory.toml:", 0), 0u) << to;
    EXPECT_KEPT(Complaint(With(from, to)));
  }
}

}  // namespace
}  // namespace twinbench::certificate
