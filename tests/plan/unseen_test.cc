#include "twin/plan/unseen.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace twinbench::plan {
namespace {

TEST(BiasesOf, AreChangesByTheirOwnUncertaintyTheMostFirst) {
  const auto without = nlohmann::json::parse(
      R"({"ez_arcsec": [1.0, 2.0], "u_ez_arcsec": [0.5, 0.5], "dy_um": [0.0, 0.0], "u_dy_um": [0.1, 0.1]})");
  const auto with = nlohmann::json::parse(
      R"({"ez_arcsec": [4.0, 6.0], "u_ez_arcsec": [0.5, 0.5], "dy_um": [0.1, -0.1], "u_dy_um": [0.1, 0.1]})");
  const std::vector<Bias> biases = BiasesOf(without, with);
  ASSERT_EQ(biases.size(), 2u);
  EXPECT_EQ(biases[0].name, "ez_arcsec");
  EXPECT_NEAR(biases[0].rms, std::sqrt(12.5), 1e-12);
  EXPECT_NEAR(biases[0].per_u, std::sqrt(12.5) / 0.5, 1e-12);
  EXPECT_NEAR(biases[1].per_u, 1.0, 1e-12);
}

TEST(BiasesOf, APhaseComesRound) {
  const auto without = nlohmann::json::parse(R"({"phase_deg": 179.0, "u_phase_deg": 1.0})");
  const auto with = nlohmann::json::parse(R"({"phase_deg": -179.0, "u_phase_deg": 1.0})");
  EXPECT_NEAR(BiasesOf(without, with).front().rms, 2.0, 1e-12);
}

}  // namespace
}  // namespace twinbench::plan
