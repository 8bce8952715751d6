#include "twin/plan/harmonics.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace twinbench::plan {
namespace {

using testing::ElementsAre;

TEST(HarmonicsOf, ReadsTermsColumnsAndTables) {
  const auto results = nlohmann::json::parse(R"({
    "model": {"terms": [{"order": 1, "amplitude_arcsec": 3.0, "u_amplitude_arcsec": 0.2},
                        {"order": 5, "amplitude_arcsec": 1.0, "u_amplitude_arcsec": 0.3}]},
    "encoder": {"order": [1, 2], "amplitude_arcsec": [1.0, 2.0], "u_amplitude_arcsec": [0.5, null]},
    "target": {"ez_arcsec": [1.0], "u_ez_arcsec": [0.1], "u_harmonics": {"order": [1, 2], "ez_arcsec": [0.7, 0.8]}},
    "against": [{"order": 1, "u_amplitude_difference_arcsec": 0.1}]})");
  const std::vector<HarmonicCertainty> found = HarmonicsOf(results);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].name, "encoder_arcsec");
  EXPECT_THAT(found[0].u, ElementsAre(0.5, testing::IsNan()));
  EXPECT_EQ(found[1].name, "model.terms_arcsec");
  EXPECT_THAT(found[1].orders, ElementsAre(1, 5));
  EXPECT_THAT(found[1].u, ElementsAre(0.2, 0.3));
  EXPECT_EQ(found[2].name, "target.ez_arcsec");
  EXPECT_THAT(found[2].u, ElementsAre(0.7, 0.8));
}

TEST(MeanOf, AveragesVariancesOfRunsThatStateThem) {
  Outlook a, b;
  a.results = {{"ez_arcsec", 2, 3.0, 3.0}, {"dy_um", 1, 1.0, 1.0}};
  b.results = {{"ez_arcsec", 2, 4.0, 4.0}};
  a.harmonics = {{"ez_arcsec", {1}, {1.0}}};
  b.harmonics = {{"ez_arcsec", {1}, {7.0}}};
  const Outlook mean = MeanOf({a, b});
  EXPECT_NEAR(mean.results[0].rms_u, std::sqrt(12.5), 1e-12);
  EXPECT_NEAR(mean.results[1].rms_u, 1.0, 1e-12);
  EXPECT_NEAR(mean.harmonics[0].u[0], 5.0, 1e-12);
  EXPECT_NEAR(LargestDifference(a, b), 1.0 / 3.0, 1e-12);
}

TEST(MeanOf, IsKnownByTheScatterOfTheRunsButForPhases) {
  std::vector<Outlook> runs;
  for (const double u : {0.9, 1.1, 0.9, 1.1}) {
    Outlook& run = runs.emplace_back();
    run.results = {{"ez_arcsec", 1, u, u}, {"terms[].phase_deg", 1, u > 1.0 ? 50.0 : 1.0, 50.0}};
  }
  // Standard deviation 0.1 sqrt(4 / 3), of the mean of four half of it; the mean is 1.
  EXPECT_NEAR(UncertaintyOfMean(runs), 0.05 * std::sqrt(4.0 / 3.0), 1e-12);
  EXPECT_NEAR(LargestDifference(runs[0], runs[1]), 0.2 / 0.9, 1e-12);
}

}  // namespace
}  // namespace twinbench::plan
