#include "twin/report/page/curves.h"

#include <random>

#include "tests/report_page/blocks.h"
#include "twin/report/page/circles.h"
#include "twin/report/page/scored.h"
#include "twin/report/page/tables.h"

namespace twinbench::report {
namespace {

using nlohmann::json, testing::DoubleNear, testing::ElementsAre;
using testing::Pointwise;

const json kResults = test::JsonOf("curves.json");

TEST(CurveFigures, HoldTheNumbersOfResultsWithTheirUncertaintyAndItsCoverage) {
  const std::vector<Figure> figures = CurveFigures(kResults, {});
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_EQ(figures[0].title, "Table: index error EZ");
  EXPECT_EQ(figures[0].y.unit, "arcsec");
  ASSERT_EQ(figures[0].series.size(), 1u);
  const FigureSeries& curve = figures[0].series[0];
  EXPECT_THAT(curve.x, ElementsAre(0, 90, 180));
  EXPECT_THAT(curve.y, ElementsAre(1.5, testing::IsNan(), -2.5));
  EXPECT_THAT(curve.u, ElementsAre(0.1, 0.2, 0.3));
  EXPECT_EQ(curve.k, 2.25);
}

const json kScore = {{"values", ScoredValuesJson({{"table.ez_arcsec[0]", 1.5, 0.1, 1.25}, {"table.ez_arcsec[2]", -2.5, 0.3, -2.75}})}};

TEST(CurveFigures, ShowTruthOnlyWhereTheScoreHasIt) {
  const std::vector<Figure> figures = CurveFigures(kResults, kScore);
  ASSERT_EQ(figures[0].series.size(), 2u);
  const FigureSeries& truth = figures[0].series[1];
  EXPECT_EQ(truth.role, SeriesRole::kTruth);
  EXPECT_EQ(truth.name, "truth");
  EXPECT_THAT(truth.y, ElementsAre(1.25, testing::IsNan(), -2.75));  // what was not scored has none
}

TEST(DeviationFigures, AreEstimatesLessTruthWithTheirUncertainty) {
  const std::vector<Figure> less = DeviationFigures(CurveFigures(kResults, kScore));
  ASSERT_EQ(less.size(), 1u);
  ASSERT_EQ(less[0].series.size(), 1u);
  EXPECT_THAT(less[0].series[0].y, ElementsAre(0.25, testing::IsNan(), 0.25));
  EXPECT_THAT(less[0].series[0].u, ElementsAre(0.1, 0.2, 0.3));
  EXPECT_TRUE(DeviationFigures(CurveFigures(kResults, {})).empty()) << "nothing is known of the truth";
}

TEST(TilesOf, SayTheLargestErrorWithItsUncertaintyAndHowErrorsCompareWithIt) {
  json results = kResults;
  results["separation"]["not_separable"] = {"table ez"};
  const json score = {{"table", {{"ez", {{"mean_chi2", 5.5}}}, {"ex", {{"mean_chi2", 0.9}}}}}};
  const std::vector<PageTile> tiles = TilesOf(results, score, CurveFigures(results, score));
  ASSERT_EQ(tiles.size(), 4u);
  EXPECT_EQ(tiles[0].value, "−2.50 ± 0.67 arcsec");  // 2.25 times 0.3, less a bit
  EXPECT_EQ(tiles[0].note, "Table: index error EZ, at 180°");
  EXPECT_EQ(tiles[1].value, "2.06 arcsec");  // of the two that there are
  EXPECT_EQ(tiles[2].value, "5.50");
  EXPECT_EQ(tiles[2].tone, VerdictTone::kBad);
  EXPECT_EQ(tiles[3].value, "1");
  EXPECT_TRUE(TilesOf(json::object(), {}, {}).empty());
}

TEST(TilesOf, SayTheLargestErrorOfAnyDirectionNotOfTheirMean) {
  const json results = {{"device", {{"position_deg", {0, 120, 240}}, {"ez_arcsec", {2.0, -1.0, -1.0}}, {"u_ez_arcsec", {0.3, 0.3, 0.3}}}},
                        {"reversal", {{"position_deg", {0, 120, 240}}, {"reversal_arcsec", {-36.0, -36.0, -38.0}}, {"u_reversal_arcsec", {0.8, 0.8, 0.8}}}}};
  std::vector<Figure> curves = CurveFigures(results, {});
  ShowDirections(results, curves);
  ASSERT_EQ(curves[0].series.size(), 2u);
  EXPECT_EQ(curves[0].series[0].name, "forward");
  EXPECT_THAT(curves[0].series[0].y, ElementsAre(-16.0, -19.0, -20.0));
  EXPECT_THAT(curves[0].series[1].y, ElementsAre(20.0, 17.0, 18.0));
  const std::vector<PageTile> tiles = TilesOf(results, {}, curves);
  EXPECT_EQ(tiles[0].value, "−20.0 ± 1.0 arcsec");  // twice hypot(0.3, 0.4)
  EXPECT_EQ(tiles[0].note, "Device under test: index error EZ, forward, at 240°");
}

TEST(ShowDirections, KeepsTheMeanBesideItsTruthAndWhatHasNoReversal) {
  const json device = {{"position_deg", {0, 120, 240}}, {"ez_arcsec", {2.0, -1.0, -1.0}}};
  const json score = {{"values", ScoredValuesJson({{"device.ez_arcsec[0]", 2.0, 0.1, 1.0}, {"device.ez_arcsec[2]", -1.0, 0.1, -2.0}})}};
  json results = {{"device", device}};
  std::vector<Figure> plain = CurveFigures(results, {});
  ShowDirections(results, plain);
  EXPECT_EQ(plain[0].series.size(), 1u);
  results["reversal"] = {{"position_deg", {0, 120, 240}}, {"reversal_arcsec", {4.0, 4.0, 4.0}}, {"u_reversal_arcsec", {1.0, 1.0, 1.0}}};
  std::vector<Figure> scored = CurveFigures(results, score);
  ShowDirections(results, scored);
  ASSERT_EQ(scored[0].series.size(), 4u);
  EXPECT_EQ(scored[0].series[0].name, "mean of both directions");
  EXPECT_EQ(scored[0].series[1].role, SeriesRole::kTruth);
  EXPECT_THAT(scored[0].series[3].y, ElementsAre(0.0, -3.0, -3.0));
}

TEST(SummedCurves, AreTheWavesOfASeparationADirectionEach) {
  const json one = {{"direction", 1}, {"order", {1, 2}}, {"amplitude_arcsec", {3.0, 4.0}}, {"phase_deg", {0.0, 0.0}}, {"u_amplitude_arcsec", {0.3, 0.4}}};
  json back = one;
  back["direction"] = -1;
  back["phase_deg"] = {180.0, 180.0};
  const json results = {{"separation", {{"table_encoder", one}, {"transmission", {one, back}}}}, {"positions", one}};
  const std::vector<Figure> curves = SummedCurves(results);
  ASSERT_EQ(curves.size(), 2u) << "of what was separated";
  EXPECT_EQ(curves[0].title, "Transmission: error");
  ASSERT_EQ(curves[0].series.size(), 2u);
  EXPECT_NEAR(curves[0].series[0].y[0], 7.0, 1e-12);
  EXPECT_NEAR(curves[0].series[1].y[0], -7.0, 1e-12);
  EXPECT_NEAR(curves[0].series[0].y[360], 1.0, 1e-12) << "at half a turn the first order is against the second";
  EXPECT_NEAR(curves[0].series[0].u[0], 0.5, 1e-12);
  EXPECT_EQ(TilesOf(results, {}, curves)[0].value, "7.0 ± 1.0 arcsec");
}

TEST(TilesOf, SayTheLargestComponentOfAMap) {
  const json results = {{"error_map", {{"x_mm", {1, 2}}, {"y_mm", {3, 4}}, {"z_mm", {5, 6}}, {"dx_um", {0.5, -0.75}}, {"u_dx_um", {0.1, 0.2}},
                                       {"dz_um", {-2.5, 1.0}}, {"u_dz_um", {0.15, 0.1}}}}};
  const std::vector<PageTile> tiles = TilesOf(results, {}, {});
  ASSERT_EQ(tiles.size(), 1u);
  EXPECT_EQ(tiles[0].value, "−2.50 ± 0.30 µm");
  EXPECT_EQ(tiles[0].note, "Error map: dz, at x 1, y 3, z 5 mm");
}

TEST(TilesOf, SayTheLargestCircularDeviationOfBothDirections) {
  const auto circle = [](int setup, double G_um) {
    return json{{"setup", setup}, {"instrument", "bar"}, {"feed_mm_min", 1000.0}, {"G_b_um", G_um}, {"u_G_b_um", 0.25}};
  };
  const std::vector<PageTile> tiles = TilesOf({{"iso230_4", {circle(0, 1.5), circle(1, 2.5)}}}, {}, {});
  ASSERT_EQ(tiles.size(), 1u);
  EXPECT_EQ(tiles[0].name, "Circular deviation G(b)");
  EXPECT_EQ(tiles[0].value, "2.50 ± 0.50 µm");
  EXPECT_EQ(tiles[0].note, "ISO 230-4, mounting 1 (bar), 1000 mm/min");
}

TEST(CurveFigures, BeginWithTheTurnOfWhatIsUnderTestWithoutCurvesOfAnotherLength) {
  const json table = {{"position_deg", {0.0, 120.0, 240.0}}, {"dx_um", {1.0, 2.0, 3.0}}, {"ez_arcsec", {3.0, 2.0, 1.0}}};
  const std::vector<Figure> figures = CurveFigures({{"separation", {{"reference", table}, {"target", table}}}}, {});
  ASSERT_EQ(figures.size(), 4U);
  EXPECT_THAT(figures[0].title, "Table under test: index error EZ");
  EXPECT_THAT(figures[1].title, "Table under test: radial error DX");
  EXPECT_THAT(figures[2].title, "Reference table: index error EZ");
  const json odd = {{"a", {{"position_deg", {0, 1, 2}}, {"ez_arcsec", {1.0, 2.0}}}}};
  EXPECT_TRUE(CurveFigures(odd, {}).empty());
}

TEST(CircleChoice, HasBothDirectionsOfASetUpAndFeedOnceRoundAndBeginsWithTheLargest) {
  json radial = json::array();
  for (const int setup : {0, 1}) {
    for (const int direction : {1, -1})
      radial.push_back({{"setup", setup}, {"pass", radial.size()}, {"direction", direction}, {"instrument", "bar"}, {"radius_mm", 100.0}, {"feed_mm_min", 40.0},
                        {"commanded_deg", {300, 420, 540}}, {"radial_um", {1.0 + setup, -direction, 0.5}}, {"u_radial_um", 0.1}});
  }
  const PageChoice choice = CircleChoice({{"radial", radial}});
  EXPECT_THAT(choice.answers, ElementsAre(ElementsAre("1 (bar)", "40 mm/min"), ElementsAre("0 (bar)", "40 mm/min")));
  const Figure& largest = choice.figures[0];
  EXPECT_EQ(largest.title, "Radial deviation, mounting 1 (bar), 40 mm/min");
  EXPECT_EQ(largest.radius, 100000.0) << "in the unit of the deviations";
  ASSERT_EQ(largest.series.size(), 2u);
  EXPECT_EQ(largest.series[0].name, "counter-clockwise");
  EXPECT_EQ(largest.series[1].name, "clockwise");
  EXPECT_THAT(largest.series[1].x, ElementsAre(60, 180, 300));
  EXPECT_THAT(largest.series[1].y, ElementsAre(1.0, 0.5, 2.0));
  EXPECT_THAT(largest.series[1].u, ElementsAre(0.1, 0.1, 0.1));
  EXPECT_TRUE(CurveFigures({{"radial", radial}}, {}).empty()) << "they are not drawn twice";
  EXPECT_TRUE(CircleChoice(kResults).figures.empty());
}

TEST(ErrorRanks, AreSharesOfTheRadialDeviationWithTheSizesOfBothAxes) {
  const json results = {{"errors", {{"machine.scale_x_um_m", {{"value", -0.25}, {"u", 0.125}, {"unit", "um/m"}}},
                                    {"machine.scale_y_um_m", {{"value", 1.0}, {"u", nullptr}, {"unit", "um/m"}}},
                                    {"bar.gain_error", {{"value", 0.5}, {"u", 0.05}, {"unit", "1"}}}}},
                        {"radial_parts", {{{"errors", {"bar.gain_error"}}, {"rms_um", 0.4}},
                                          {{"errors", {"machine.scale_x_um_m", "machine.scale_y_um_m"}}, {"rms_um", 0.2}},
                                          {{"errors", {"machine.lag_x_s"}}, {"rms_um", 0.1}}}}};
  const PageTable table = ErrorRankTable(results);
  ASSERT_EQ(table.rows.size(), 2u) << "what the run does not show has no share";
  EXPECT_THAT(table.rows[0], ElementsAre("bar gain error", "0.50 ± 0.10", "0.4", "80 %"));
  EXPECT_THAT(table.rows[1], ElementsAre("machine scale x and y", "x −0.25 ± 0.25 µm/m", "0.2", "20 %"));
  EXPECT_THAT(ErrorRankFigure(results).categories, ElementsAre("bar gain error", "machine scale x and y"));
}

TEST(SpectrumFigures, ReadListsAndListsOfTerms) {
  const std::vector<Figure> figures = SpectrumFigures(kResults, {});
  ASSERT_EQ(figures.size(), 1u) << "uncertainties of orders are the limits of a spectrum, and none of their own";
  EXPECT_EQ(figures[0].title, "Model terms: amplitude");
  EXPECT_THAT(figures[0].series[0].x, ElementsAre(1, 7));
  EXPECT_THAT(figures[0].series[0].y, ElementsAre(6.5, 0.25));
  EXPECT_THAT(figures[0].series[0].u, ElementsAre(0.5, 0.125));
  // Rayleigh: with probability 0.05 the root of the sum of two squares is above 2.4477 of their standard deviation.
  ASSERT_EQ(figures[0].series.size(), 2u);
  EXPECT_EQ(figures[0].series[1].role, SeriesRole::kExpected);
  EXPECT_THAT(figures[0].series[1].y, Pointwise(DoubleNear(1e-4), {1.2239, 0.3060}));
}

Figure CurveOf(int n, double amplitude, int order) {
  FigureSeries series{"a", SeriesRole::kEstimate, {}, {}, {}};
  for (int k = 0; k < n; ++k) {
    series.x.push_back(360.0 * k / n);
    series.y.push_back(5.0 + amplitude * std::cos(2.0 * std::numbers::pi * order * k / n + 0.3));
  }
  return {FigureForm::kAngle, "t", "", {"position", "deg"}, {"ez", "arcsec"}, {series}};
}

TEST(HarmonicsOf, AWaveIsItsAmplitudeAtItsOrderAndNothingElse) {
  const auto figure = HarmonicsOf(CurveOf(20, 3.0, 4));
  ASSERT_TRUE(figure.has_value());
  EXPECT_THAT(figure->series[0].x, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
  // Rounding of a sum of 20 terms: 1e-14.
  EXPECT_THAT(figure->series[0].y, Pointwise(DoubleNear(1e-12), {0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0}));
}

TEST(HarmonicsOf, OfNoiseFivePercentAreAboveTheLineOfItsPoints) {
  constexpr int kPoints = 2000;
  Figure noise = CurveOf(kPoints, 0.0, 1);
  FigureSeries& points = noise.series[0];
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.0, 0.25);
  for (double& y : points.y) y += normal(random);
  points.u.assign(kPoints, 0.25);
  const Figure spectrum = *HarmonicsOf(noise);
  ASSERT_EQ(spectrum.series.size(), 2u);
  int above = 0;
  for (std::size_t k = 0; k < spectrum.series[0].y.size(); ++k) above += spectrum.series[0].y[k] > spectrum.series[1].y[k] ? 1 : 0;
  // 999 orders: 50 with a standard deviation of 7.
  EXPECT_NEAR(above, 50, 21);
  points.u_order = {0.5};
  EXPECT_NEAR(HarmonicsOf(noise)->series[1].y[0], 1.2239, 1e-4) << "as it is stated, where it is";
}

TEST(HarmonicsOf, ThereAreNoneOfACurveWithAGapOrOfPartOfACircle) {
  Figure gap = CurveOf(20, 3.0, 4);
  gap.series[0].y[5] = std::nan("");
  EXPECT_FALSE(HarmonicsOf(gap).has_value());
  Figure part = CurveOf(20, 3.0, 4);
  for (double& x : part.series[0].x) x /= 2.0;
  EXPECT_FALSE(HarmonicsOf(part).has_value());
}

}  // namespace
}  // namespace twinbench::report
