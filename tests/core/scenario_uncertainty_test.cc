#include "twin/core/scenario_uncertainty.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/input_error.h"
#include "tests/core/refusals.h"
#include "twin/core/units.h"

namespace twinbench {
namespace {

Scenario Parsed(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return ParseScenario("bench = \"rotary_4dof\"\n" + text, "s.toml", "", overrides);
}

TEST(ScenarioUncertainty, IsReadInTheUnitOfItsKeyAlsoOnTheCommandLine) {
  EXPECT_DOUBLE_EQ(Parsed("", {"psd_a.u_distance_mm=0.1"}).uncertainties.at(0).u, 0.1 * units::mm);
  const Scenario s = Parsed(
      "[laser]\nu_wavelength_nm = 0.01\n[psd_a]\nu_distance_mm = { half_width = 0.3, distribution = \"uniform\" "
      "}\n");
  ASSERT_EQ(s.uncertainties.size(), 2U);
  EXPECT_EQ(s.uncertainties[0].key, "laser.wavelength_nm");
  EXPECT_DOUBLE_EQ(s.uncertainties[0].u, 0.01 * units::nm);
  EXPECT_TRUE(std::isinf(s.uncertainties[0].dof));
  EXPECT_EQ(s.uncertainties[1].distribution, Distribution::kUniform);
  EXPECT_DOUBLE_EQ(s.uncertainties[1].u, 0.3 * units::mm / std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(HalfWidth(s.uncertainties[1]), 0.3 * units::mm);
}

TEST(ScenarioUncertainty, ComesBackFromTheFileThatIsWritten) {
  const Scenario s = Parsed(
      "[psd_b]\nu_distance_mm = { u = 0.25, dof = 8, distribution = \"triangular\" }\n[grating]\nu_point_mm = "
      "0.5\n");
  const Scenario again = ParseScenario(WriteScenario(s), "again.toml", "");
  ASSERT_EQ(again.uncertainties.size(), s.uncertainties.size());
  for (std::size_t i = 0; i < s.uncertainties.size(); ++i) {
    EXPECT_EQ(again.uncertainties[i].key, s.uncertainties[i].key);
    EXPECT_EQ(again.uncertainties[i].u, s.uncertainties[i].u);
    EXPECT_EQ(again.uncertainties[i].dof, s.uncertainties[i].dof);
    EXPECT_EQ(again.uncertainties[i].distribution, s.uncertainties[i].distribution);
  }
}

TEST(ScenarioUncertainty, WhatCannotBeIsRefusedWithWhatIsExpected) {
  ExpectRefused("s.toml", [](const auto& text) { return MessageOf([&] { Parsed(text); }); },
                {{3, "[laser]\nu_wavelength_nm = -0.01\n"},
                 {3, "[laser]\nu_wavelength_nm = { half_width = 0.1 }\n"},
                 {3, "[laser]\nu_wavelength_nm = { u = 0.1, width = 2 }\n"},
                 {3, "[laser]\nu_beam = 0.1\n"}});  // a word has none
}

TEST(ScenarioUncertainty, FindsTheNumbersOfAKey) {
  Scenario s = Parsed("");
  NumbersAt(s, "psd_a.distance_mm")[0] = 0.2;
  EXPECT_NE(WriteScenario(s).find("distance_mm = 200.0"), std::string::npos);
  EXPECT_EQ(NumbersAt(s, "grating.point_mm").size(), 3U);
  EXPECT_THROW(NumbersAt(s, "laser.beam"), std::logic_error);
}

}  // namespace
}  // namespace twinbench
