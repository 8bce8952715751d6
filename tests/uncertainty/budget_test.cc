#include <numeric>

#include "tests/uncertainty/bench_budget.h"
#include "twin/core/linear_algebra.h"
#include "twin/report/uncertainty_text.h"
#include "twin/uncertainty/joint.h"
#include "twin/uncertainty/quantities.h"

namespace twinbench::uncertainty {
namespace {

using test::Computing, test::FourInputs, test::Input, test::InputKeys;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

void ExpectAddsUp(const Budget& budget) {
  double sum2 = 0.0;
  for (const Source& source : budget.sources) sum2 += source.u * source.u;
  EXPECT_NEAR(sum2, budget.u * budget.u, 1e-9 * sum2);
}

/// The end gauge of GUM, H.1, with its four largest contributions [nm] and their degrees of freedom.
TEST(Budget, OfTheEndGaugeIsThatOfTheGuide) {
  const Scenario scenario = FourInputs({{InputKeys()[0], 9.7e-9, Distribution::kNormal, 25.6},
                                        {InputKeys()[1], 2.9e-9, Distribution::kNormal, 50.0},
                                        {InputKeys()[2], 16.6e-9, Distribution::kNormal, 2.0}});
  const auto length_nm = [](const Scenario& s) { return 1e9 * (Input(s, 0) + Input(s, 1) - Input(s, 2)); };
  const Budget budget = Budgets(scenario, Computing("length_nm", length_nm, 25.0, 18.0)).at(0);
  ExpectAddsUp(budget);
  EXPECT_NEAR(budget.u, 31.67, 0.01);
  EXPECT_NEAR(budget.dof, 16.76, 0.01);
  EXPECT_NEAR(budget.k, 2.112, 0.002) << "Student's t at 16.76 degrees of freedom";
  ASSERT_EQ(budget.sources.size(), 4U) << "a straight line has no second order";
  EXPECT_EQ(budget.sources[0].type, 'A');
  EXPECT_NEAR(budget.sources[3].u, -16.6, 1e-6) << "with the sign of the sensitivity";
}

TEST(Budget, TakesEveryNumberOfAList) {
  const Scenario scenario = FourInputs({{"grating.point_mm", 1e-3}});
  const auto sum = [](Scenario s) {
    const auto numbers = NumbersAt(s, "grating.point_mm");
    return std::accumulate(numbers.begin(), numbers.end(), 0.0);
  };
  const Budget budget = Budgets(scenario, Computing("sum", sum)).at(0);
  EXPECT_NEAR(budget.u, std::sqrt(3.0) * 1e-3, 1e-12);
  EXPECT_EQ(budget.sources[2].name, "grating.point_mm[1]");
}

TEST(Budgets, NameWhatNoResultIsComputedWith) {
  const Scenario scenario = FourInputs({{"grating.point_mm", 1e-3}, {"laser.wavelength_nm", 1e-11}});
  const auto first = [](const Scenario& s) {
    Scenario copy = s;
    return std::vector<Quantity>{{"first", NumbersAt(copy, "grating.point_mm")[0], 0.1},
                                 {"wave", 2.0 * NumbersAt(copy, "laser.wavelength_nm")[0], 0.1}};
  };
  EXPECT_EQ(SourcesOfNothing(Budgets(scenario, first)),
            (std::vector<std::string>{"grating.point_mm[1]", "grating.point_mm[2]"}));
}

/// 0.3 arcsec per um of a distance that is known to 2 um.
TEST(Budget, StatesSensitivitiesInTheUnitOfTheKey) {
  const Scenario scenario = FourInputs({{InputKeys()[0], 2e-6}});
  const auto line = Computing("ez_arcsec", [](const Scenario& s) { return -0.3e6 * Input(s, 0); }, 0.1);
  const Source source = Budgets(scenario, line).at(0).sources.at(1);
  EXPECT_NEAR(source.u_input, 2e-3, 1e-12) << "mm, as distance_mm";
  EXPECT_EQ(source.input_unit, "mm");
  EXPECT_NEAR(source.sensitivity, -300.0, 1e-6) << "arcsec per mm";
  EXPECT_NEAR(source.u, source.sensitivity * source.u_input, 1e-12);
}

/// What an estimator tells apart stands line by line, but its degrees of freedom are those of one estimate.
TEST(Budget, HasThePartsOfTheReadings) {
  const Scenario scenario = FourInputs({{InputKeys()[0], 1e-3, Distribution::kNormal, 5.0}});
  const auto evaluate = [](const Scenario& s) {
    const double x = 1e3 * Input(s, 0);
    return std::vector<Quantity>{
        {"y", x + x * x, 2.0, 10.0, {{"noise", 0.5}, {"quantisation", 0.25}, {"second order", 0.25}}}};
  };
  const Budget budget = Budgets(scenario, evaluate).at(0);
  ASSERT_EQ(budget.sources.size(), 4U) << "both second orders in one line";
  EXPECT_EQ(budget.sources[0].type, 'A');
  EXPECT_EQ(budget.sources[1].type, 'B');
  EXPECT_NEAR(budget.sources[0].u, std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(budget.sources[2].u, std::sqrt(1.0 + 2.0), 1e-9) << "0.25 of 4, and 2 x 1^2 of the key";
  EXPECT_NEAR(budget.u * budget.u, 4.0 + 1.0 + 2.0, 1e-9);
  ExpectAddsUp(budget);
  EXPECT_NEAR(budget.dof, 49.0 / (16.0 / 10.0 + 1.0 / 5.0), 1e-6);
}

TEST(Quantities, AreTheNumbersWithAnUncertaintyBesideThemAndEndInTheirUnits) {
  const auto results = nlohmann::json::parse(R"({
    "calibration": {"dof": 12, "gain": {"psd_a_x": {"value": 0.99, "u": 0.01}}},
    "separation": {"target": {"ez_arcsec": [1.0, null, 3.0], "u_ez_arcsec": [0.1, 0.2, 0.3], "position_deg": [0, 1, 2]}},
    "stability": {"standard_deviation": {"dy_um": 0.3}, "u_standard_deviation": {"dy_um": 0.02}, "readings": 5},
    "diagnosis": {"x": {"value": 1.0, "u": 1.0}}})");
  const std::vector<Quantity> found = QuantitiesOf(results);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0].name, "calibration.gain.psd_a_x");
  EXPECT_EQ(found[0].dof, 12.0);
  EXPECT_EQ(found[1].name, "separation.target.ez_arcsec[0]");
  EXPECT_TRUE(std::isinf(found[1].dof));
  EXPECT_EQ(found[2].name, "separation.target.ez_arcsec[2]") << "what is null was not measured";
  EXPECT_EQ(found[2].u, 0.3);
  EXPECT_EQ(found[3].name, "stability.standard_deviation.dy_um");
  EXPECT_EQ(ListOf(found[2].name), "separation.target.ez_arcsec");
  EXPECT_EQ(KindOf("iso230_2[2].targets[17].mean_arcsec[3]"), "iso230_2[].targets[].mean_arcsec");
  EXPECT_EQ(UnitOf("separation.target.ez_arcsec[3]"), "arcsec");
  EXPECT_EQ(UnitOf("setups[0].offset_x_um"), "um");
  EXPECT_EQ(UnitOf("calibration.gain.psd_a_x"), "") << "x is no unit";
}

TEST(Quantities, HaveTheirPartsNearestAbove) {
  const auto json = nlohmann::json::parse(R"({
    "map": {"ez_arcsec": [1.0, 2.0], "u_ez_arcsec": [0.1, 0.2], "u_parts": {"noise": [0.25, 1.0], "drift": [0.75, null]}},
    "table": {"ex_arcsec": [1.0], "u_ex_arcsec": [0.1], "dy_um": [1.0], "u_dy_um": [0.1],
              "u_parts": {"ex_arcsec": {"noise": 1.0}}},
    "errors": {"u_parts": {"noise": 0.5}, "a": {"value": 1.0, "u": 0.1}},
    "plain": {"value": 1.0, "u": 0.1}})");
  const std::vector<Quantity> found = QuantitiesOf(json);
  ASSERT_EQ(found.size(), 6U) << "u_parts is no result";
  const auto parts_of = [&](const std::string& name) {
    std::map<std::string, double> parts;
    for (const Part& p : std::ranges::find(found, name, &Quantity::name)->parts) parts[p.name] = p.share;
    return parts;
  };
  using Parts = std::map<std::string, double>;
  EXPECT_EQ(parts_of("map.ez_arcsec[0]"), (Parts{{"noise", 0.25}, {"drift", 0.75}}));
  EXPECT_EQ(parts_of("map.ez_arcsec[1]"), (Parts{{"noise", 1.0}}));
  EXPECT_EQ(parts_of("table.ex_arcsec[0]"), (Parts{{"noise", 1.0}}));
  EXPECT_EQ(parts_of("table.dy_um[0]"), Parts{}) << "only that of another key is stated";
  EXPECT_EQ(parts_of("errors.a"), (Parts{{"noise", 0.5}}));
  EXPECT_EQ(parts_of("plain"), Parts{});
}

TEST(StatedQuantities, AreThoseWithAnUncertaintyInEachOfItsForms) {
  const auto json = nlohmann::json::parse(R"({"a": {"value": 1, "u": 0.1, "unit": "um"},
    "b": {"value_um": 2, "u_um": 0.2, "bias_um": 9}, "c": {"ez_arcsec": [3, 4], "u_ez_arcsec": [0.3, null],
    "position_deg": [0, 10]}, "d": [{"D_um": 5, "u_D_um": 0.5, "feed": 7}], "dof": 8})");
  const auto is = [](const char* name, double value) {
    return testing::AllOf(testing::Field(&Quantity::name, name), testing::Field(&Quantity::value, value));
  };
  EXPECT_THAT(StatedQuantities(json), testing::ElementsAre(is("a", 1), is("b_um", 2), is("c.ez_arcsec[0]", 3),
                                                           is("c.ez_arcsec[1]", 4), is("d[0].D_um", 5)));
  EXPECT_EQ(QuantitiesOf(json).size(), 4U) << "without the one whose uncertainty is not known";
}

/// Deviations of four readings of unit variance from their mean: cov = 1 - 1/4 everywhere, rank 3.
Eigen::MatrixXd OfDeviations() { return Eigen::MatrixXd::Identity(4, 4) - Eigen::MatrixXd::Constant(4, 4, 0.25); }

TEST(Joint, HasARootWithoutTheDirectionsThatAreNoneAndLosesNoneToItsUnits) {
  const Eigen::MatrixXd root = RootOf(OfDeviations());
  EXPECT_EQ(root.cols(), 3);
  EXPECT_LT((root * root.transpose() - OfDeviations()).cwiseAbs().maxCoeff(), 1e-12);
  // Units of a thousand to one beside each other lose no direction.
  Eigen::MatrixXd cov(2, 2);
  cov << 1.0, 0.5e-6, 0.5e-6, 1e-12;
  EXPECT_EQ(RootOf(cov).cols(), 2);
  EXPECT_NEAR(CorrelationOf(cov)(0, 1), 0.5, 1e-12);
}

/// JCGM 102, 6.2: a constant that all results are computed with correlates them.
TEST(Joint, GainsWhatASharedConstantAdds) {
  const Scenario scenario = FourInputs({{InputKeys()[0], 1e-3}});
  const auto evaluate = [](const Scenario& s) {
    return std::vector<Quantity>{{"a[0]", 2e3 * Input(s, 0), 1.0}, {"a[1]", -1e3 * Input(s, 0), 1.0}};
  };
  const Joint readings{"a", {"a[0]", "a[1]"}, Eigen::Matrix2d::Identity()};
  const Joint combined = Combined(readings, Budgets(scenario, evaluate));
  EXPECT_NEAR(combined.cov(0, 0), 5.0, 1e-9);
  EXPECT_NEAR(combined.cov(0, 1), -2.0, 1e-9);
  EXPECT_NEAR(combined.cov(1, 1), 2.0, 1e-9);
}

/// Trials draw together what the estimator states together: the covariance comes back, and so does the constant's.
TEST(Propagate, DrawsJointsTogether) {
  const Scenario scenario = FourInputs({{InputKeys()[0], 1e-3}});
  const auto evaluate = [](const Scenario& s) {
    std::vector<Quantity> all;
    for (int i = 0; i < 4; ++i) all.push_back({"a[" + std::to_string(i) + "]", 1e3 * Input(s, 0), std::sqrt(0.75)});
    return all;
  };
  const MonteCarloOptions options = test::Trials(4000, {{"a", {"a[0]", "a[1]", "a[2]", "a[3]"}, OfDeviations()}});
  const JointSpread spread = Propagate(scenario, evaluate, options).together.at(0);
  const Eigen::MatrixXd expected = OfDeviations() + Eigen::MatrixXd::Constant(4, 4, 1.0);
  // A variance of 4000 trials is known to sqrt(2 / 4000) = 2.2 %.
  EXPECT_LT((spread.joint.cov - expected).cwiseAbs().maxCoeff(), 0.16);
  EXPECT_EQ(spread.region.dimensions, 4);
  // Four dimensions of a normal distribution: chi^2 of 0.95 is 9.49.
  EXPECT_NEAR(spread.region.ellipsoid_gum_k, 3.080, 0.001);
  EXPECT_NEAR(spread.region.ellipsoid_k, 3.080, 0.12);
}

/// Independent results: all of m within k u at once with probability (2 Phi(k) - 1)^m; m = 4, 95 %: k = 2.49.
TEST(Propagate, FindsTheBandOfAllAtOnce) {
  const auto evaluate = [](const Scenario&) {
    return std::vector<Quantity>{{"a", 0.0, 1.0}, {"b", 0.0, 1.0}, {"c", 0.0, 1.0}, {"d", 0.0, 1.0}};
  };
  const MonteCarloOptions options = test::Trials(4000, {{"all", {"a", "b", "c", "d"}, Eigen::Matrix4d::Identity()}});
  EXPECT_NEAR(Propagate(FourInputs({}), evaluate, options).together.at(0).region.rectangle_k, 2.49, 0.12);
}

/// Few degrees of freedom widen all of a joint by the same chi-squared: the multivariate t distribution has
/// dof / (dof - 2) times the variance.
TEST(Propagate, DrawsJointsOfFewDegreesOfFreedom) {
  const auto evaluate = [](const Scenario&) {
    return std::vector<Quantity>{{"a", 0.0, 1.0, 8.0}, {"b", 0.0, 1.0, 8.0}};
  };
  const MonteCarloOptions options = test::Trials(4000, {{"ab", {"a", "b"}, Eigen::Matrix2d::Identity()}});
  const Eigen::MatrixXd cov = Propagate(FourInputs({}), evaluate, options).together.at(0).joint.cov;
  EXPECT_NEAR(cov(0, 0), 8.0 / 6.0, 0.15);
  EXPECT_NEAR(cov(0, 1), 0.0, 0.1);
}

void ExpectStatedUncertainties(const Scenario& scenario) {
  SCOPED_TRACE(scenario.bench);
  const std::vector<Reading> readings = test::ReadingsOf(scenario);
  const report::Evaluation evaluation = BenchOf(scenario).evaluate(scenario, readings, Estimator::kRigorous);
  const std::vector<Quantity> quantities = QuantitiesOf(evaluation.results);
  std::vector<std::string> names;
  for (const Quantity& q : quantities) names.push_back(q.name);
  int compared = 0;
  for (const Joint& stated : evaluation.Joints()) {
    const Joint joint = Determined(stated, names);
    for (std::size_t i = 0; i < joint.names.size(); ++i) {
      const double u = std::ranges::find(quantities, joint.names[i], &Quantity::name)->u;
      const auto at = static_cast<Eigen::Index>(i);
      EXPECT_NEAR(joint.cov(at, at), u * u, 1e-6 * u * u) << joint.names[i];
      ++compared;
    }
    EXPECT_GE(EigenvaluesOfSymmetric(CorrelationOf(joint.cov))[0], -1e-6) << joint.name;
  }
  const bool has_map = scenario.bench != std::string("hob_transmission");  // its orders are independent of each other
  EXPECT_EQ(compared > 10, has_map);
}

/// The diagonal is the square of the u beside each result, and there is one for each that was determined.
TEST(Joint, OfEveryBenchHasTheStatedUncertainties) {
  for (const test::SmallBench& bench : test::SmallBenches()) ExpectStatedUncertainties(test::Small(bench));
}

TEST(BudgetJson, HasTheCovariance) {
  const auto evaluate = [](const Scenario&) { return std::vector<Quantity>{{"a", 0.0, 1.0}, {"b", 0.0, 2.0}}; };
  Eigen::Matrix2d cov;
  cov << 1.0, 1.0, 1.0, 4.0;
  const auto json = report::BudgetJson(Budgets(FourInputs({}), evaluate), {{"ab", {"a", "b"}, cov}});
  EXPECT_EQ(json.at("covariance").at(0).at("quantities").at(1), "b");
  EXPECT_DOUBLE_EQ(json.at("covariance").at(0).at("covariance").at(1).at(0).get<double>(), 1.0);
  EXPECT_DOUBLE_EQ(json.at("covariance").at(0).at("correlation").at(1).at(0).get<double>(), 0.5);
}

}  // namespace
}  // namespace twinbench::uncertainty
