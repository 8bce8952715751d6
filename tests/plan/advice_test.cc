#include "twin/plan/advice.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace twinbench::plan {
namespace {

const nlohmann::json kBefore = nlohmann::json::parse(
    R"({"target": {"ez_arcsec": [0, 0], "u_ez_arcsec": [0.3, 0.4], "dy_um": [0], "u_dy_um": [1.0]}})");
const nlohmann::json kMore =
    nlohmann::json::parse(R"({"target": {"ez_arcsec": [0, 0], "u_ez_arcsec": [0.3, 0.4]}})");

TEST(GainsOf, AddsInverseVariancesPlaceByPlace) {
  const std::vector<Gain> gains = GainsOf(kBefore, kMore, "");
  ASSERT_EQ(gains.size(), 1u);  // dy is not determined again
  EXPECT_EQ(gains.front().name, "target.ez_arcsec");
  EXPECT_NEAR(gains.front().ratio, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(MeanGain_bit(gains), 0.5, 1e-12);
}

TEST(GainsOf, AddsThePrecisionOfAWholeProgramme) {
  const std::vector<Gain> gains = GainsOf(kBefore, {&kMore, &kBefore, &kMore}, "");
  ASSERT_EQ(gains.size(), 2u);
  EXPECT_NEAR(gains[0].ratio, std::sqrt(0.5), 1e-12) << "dy is determined by one of the three";
  EXPECT_NEAR(gains[1].ratio, 0.5, 1e-12) << "four runs";
}

TEST(GainsOf, OnlyOfWhatIsWanted) {
  EXPECT_EQ(GainsOf(kBefore, kBefore, "target.dy").size(), 1u);
  EXPECT_EQ(GainsOf(kBefore, kBefore, "dy_um").size(), 1u);
  EXPECT_TRUE(GainsOf(kBefore, kBefore, "get.dy").empty());
}

TEST(Rank, PutsWhatBuysMostPerMinuteFirst) {
  std::vector<Advice> advice(2);
  advice[0].of_causes_bit = 10.0;
  advice[0].minutes = 100.0;
  advice[1].of_causes_bit = 4.0;
  advice[1].minutes = 10.0;
  Rank(advice);
  EXPECT_EQ(advice.front().minutes, 10.0);
}

}  // namespace
}  // namespace twinbench::plan
