#include <Eigen/LU>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/distributions.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/textbook.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::screen {
namespace {

TEST(RunsScore, IsThatOfWaldAndWolfowitz) {
  // ++++---+++--++++++---- : 13 above, 9 below, 6 runs; mean 1 + 234/22, variance 234 (234 - 22) / (22^2 21).
  const Eigen::VectorXd series{{1, 2, 1, 3, -1, -1, -2, 1, 1, 4, -1, -1, 2, 2, 1, 1, 1, 1, -1, -3, -1, -1}};
  EXPECT_NEAR(RunsScore(series), (6.0 - 1.0 - 234.0 / 22.0) / std::sqrt(234.0 * 212.0 / (484.0 * 21.0)), 1e-12);
  EXPECT_EQ(RunsScore(Eigen::VectorXd::Ones(9)), 0.0);
}

TEST(LjungBox, OfAnAlternatingSeriesIsItsClosedForm) {
  const Eigen::VectorXd correlation = Autocorrelation(Eigen::VectorXd{{2, -2, 2, -2, 2, -2, 2, -2, 2, -2}}, 2);
  EXPECT_NEAR(correlation[0], -0.9, 1e-12);
  EXPECT_NEAR(correlation[1], 0.8, 1e-12);
  EXPECT_NEAR(LjungBox(correlation, 10), 10.0 * 12.0 * (0.81 / 9.0 + 0.64 / 8.0), 1e-12);
}

TEST(LombScargle, IsWhatTheLeastSquaresOfASineTakeOff) {
  Eigen::VectorXd at = RandomMatrix("test.at", 60, 1).cwiseAbs() * 9.0;  // uneven
  const Eigen::MatrixXd series = RandomMatrix("test.series", 60, 2);
  const Eigen::MatrixXd power = LombScargle(at, 0.31, 40).Of(series);
  for (int k : {1, 7, 40}) {
    const Eigen::MatrixXd wave = model::Wave(0.31 * k * at);
    const Eigen::MatrixXd fitted = wave * (wave.transpose() * wave).inverse() * (wave.transpose() * series);
    for (int j = 0; j < 2; ++j) {
      const double mean_square = series.col(j).squaredNorm() / 60.0;
      EXPECT_NEAR(power(k - 1, j), fitted.col(j).squaredNorm() / (2.0 * mean_square), 1e-9);
    }
  }
}

TEST(JarqueBera, OfTwoLevelsIsASixthOfTheReadings) {
  const Shape shape = ShapeOf(Eigen::VectorXd{{3, 1, 3, 1, 1, 3, 1, 3, 3, 1, 1, 3}});
  EXPECT_NEAR(shape.skewness, 0.0, 1e-12);
  EXPECT_NEAR(shape.kurtosis, 1.0, 1e-12);
  EXPECT_NEAR(JarqueBera(shape, 12), 12.0 / 6.0 * (2.0 * 2.0 / 4.0), 1e-12);
}

TEST(JarqueBera, SeesASkewWithItsSign) {
  const Shape shape = ShapeOf(Eigen::VectorXd{{0, 0, 0, 4}});  // mean 1: m2 = 3, m3 = 6, m4 = 21
  EXPECT_NEAR(shape.skewness, 6.0 / std::pow(3.0, 1.5), 1e-12);
  EXPECT_NEAR(shape.kurtosis, 21.0 / 9.0, 1e-12);
}

TEST(Bartlett, OfTwoVariancesIsItsClosedForm) {
  // 4 and 1 of 9 degrees of freedom each: 18 ln 2.5 - 9 ln 4, over 1 + (2/9 - 1/18) / 3.
  const double expected = (18.0 * std::log(2.5) - 9.0 * std::log(4.0)) / (1.0 + (2.0 / 9.0 - 1.0 / 18.0) / 3.0);
  EXPECT_NEAR(Bartlett(Eigen::Array2d(36.0, 9.0), Eigen::Array2d(9.0, 9.0)), expected, 1e-12);
  EXPECT_NEAR(Bartlett(Eigen::Array2d(8.0, 12.0), Eigen::Array2d(4.0, 6.0)), 0.0, 1e-12);
}

TEST(NormalScore, IsAsImprobableAsTheChiSquared) {
  for (double dof : {2.0, 10.0, 100.0}) {
    for (double chi2 : {0.5 * dof, dof, 2.0 * dof}) {
      // Wilson and Hilferty are within 0.02 standard deviations from two degrees of freedom on.
      const double tail = 0.5 * std::erfc(NormalScore(chi2, dof) / std::sqrt(2.0));
      EXPECT_NEAR(tail, ChiSquaredExceedance(chi2, dof), 0.01) << dof;
    }
  }
}

TEST(PValue, CountsTheNullsThatAreAtLeastAsLarge) {
  Eigen::VectorXd statistic = Eigen::VectorXd::LinSpaced(100, 0.0, 99.0);  // entry 0 is the run
  statistic[0] = 50.0;
  // 50, 51, ..., 99 and the run itself: 51 of 100.
  EXPECT_DOUBLE_EQ(PValue(statistic), 0.51);
}

TEST(PValue, GoesOnBeyondTheLargestNullAsAnExponential) {
  // Quantiles of an exponential of mean 1: the fitted tail must give exp(-t).
  Eigen::VectorXd statistic(1001);
  for (int i = 1; i <= 1000; ++i) statistic[i] = -std::log((i - 0.5) / 1000.0);
  statistic[0] = 14.0;
  // The mean excess of 100 quantiles is within 1 % of 1; over the 11.7 from threshold to 14 that is 12 % of p.
  EXPECT_NEAR(PValue(statistic) / std::exp(-14.0), 1.0, 0.15);
}

}  // namespace
}  // namespace twinbench::diagnose::screen
