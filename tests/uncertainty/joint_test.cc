#include "twin/uncertainty/joint.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/uncertainty/bench_budget.h"
#include "twin/core/linear_algebra.h"
#include "twin/report/uncertainty_text.h"
#include "twin/uncertainty/monte_carlo.h"

namespace twinbench::uncertainty {
namespace {

using test::FourInputs, test::Input, test::InputKeys;

/// Deviations of four readings of unit variance from their mean: cov = 1 - 1/4 everywhere, rank 3.
Eigen::MatrixXd OfDeviations() {
  return Eigen::MatrixXd::Identity(4, 4) - Eigen::MatrixXd::Constant(4, 4, 0.25);
}

TEST(Joint, HasARootWithoutTheDirectionsThatAreNone) {
  const Eigen::MatrixXd root = RootOf(OfDeviations());
  EXPECT_EQ(root.cols(), 3);
  EXPECT_LT((root * root.transpose() - OfDeviations()).cwiseAbs().maxCoeff(), 1e-12);
}

/// Units of a thousand to one beside each other lose no direction.
TEST(Joint, LosesNoDirectionToItsUnits) {
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

class JointOfEveryBench : public testing::TestWithParam<test::SmallBench> {};

/// The diagonal is the square of the u beside each result, and there is one for each that was determined.
TEST_P(JointOfEveryBench, HasTheStatedUncertainties) {
  const Scenario scenario = test::Small(GetParam());
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

INSTANTIATE_TEST_SUITE_P(Joint, JointOfEveryBench, testing::ValuesIn(test::SmallBenches()), [](const auto& of) {
  return of.param.file.substr(0, of.param.file.find('.'));
});

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
