#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"
#include "twin/diagnose/screen/estimators.h"

namespace twinbench::diagnose {
namespace {

/// Uneven: steps between 1 and 3.
Eigen::VectorXd Times_s(int count) {
  Stream stream(1, "test.times");
  Eigen::VectorXd time_s(count);
  for (int i = 0; i < count; ++i) time_s[i] = (i > 0 ? time_s[i - 1] : 100.0) + 1.0 + 2.0 * stream.Uniform();
  return time_s;
}

/// Against sums, to six digits of the largest possible one: root of readings times the norm.
void ExpectSums(const Eigen::VectorXd& time_s, const Eigen::MatrixXd& series, double step_Hz, int count) {
  const auto readings = static_cast<double>(time_s.size());
  const Eigen::MatrixXcd spectrum = screen::Spectrum(time_s, series, step_Hz, count);
  for (int k = 1; k <= count; ++k) {
    for (Eigen::Index j = 0; j < series.cols(); ++j) {
      std::complex<double> sum = 0.0;
      for (Eigen::Index i = 0; i < series.rows(); ++i)
        sum += series(i, j) * std::polar(1.0, -2.0 * units::kPi * k * step_Hz * (time_s[i] - time_s[0]));
      EXPECT_LT(std::abs(spectrum(k - 1, j) - sum), 1e-6 * readings) << k;
    }
  }
}

TEST(Spectrum, AgreesWithSumsOverUnevenTimes) {
  const Eigen::VectorXd time_s = Times_s(300);
  Eigen::MatrixXd series(300, 2);
  series << RandomMatrix("test.spectrum 2", 300, 1), RandomMatrix("test.spectrum 3", 300, 1);
  ExpectSums(time_s, series, 0.5 / (time_s[299] - time_s[0]), 250);
}

TEST(Spectrum, AgreesWhereTheStepsWrapAroundTheRun) {
  const Eigen::VectorXd time_s = Times_s(50);
  ExpectSums(time_s, RandomMatrix("test.spectrum 2", 50, 1), 3.3 / (time_s[49] - time_s[0]), 4);
}

TEST(Tones, AreFoundAtAnyFrequencyOfALongRun) {
  const LinearRun clean =
      SyntheticRun({.positions = 24, .shifts = {0, 1, 5, 7}, .passes = {1, -1, -1, 1, 1, -1, -1, 1, 1, -1, -1, 1}});
  const Eigen::VectorXd time_s = clean.schedule.time_s;
  for (double period_s : {19.37, 41.91, 333.3}) {
    LinearRun run = clean;
    AddNoise(run, 1);
    AddEffect(run, Eigen::Vector4d(0, 1, 0, 1),
              [&](int i) { return 0.12e-6 * std::cos(2.0 * units::kPi * time_s[i] / period_s); });
    const ScreenTest tone = Loud(ScreenAsStated(run, 100, 1), "time: tone", 0.01, "in tilt");
    const auto at = tone.reading.find("period ");
    ASSERT_NE(at, std::string::npos) << tone.reading;
    // Steps of half a cycle over the run: the nearest is a quarter away, or two where noise decides between
    // neighbours.
    const double duration_s = time_s[time_s.size() - 1] - time_s[0];
    EXPECT_NEAR(duration_s / std::stod(tone.reading.substr(at + 7)), duration_s / period_s, 0.8);
    // Amplitude of 1152 readings on two channels: 0.3 um / sqrt(1152) = 0.009 um; a quarter cycle off takes 10 %.
    EXPECT_NEAR(tone.effect_m, 0.12e-6, 0.04e-6);
  }
}

TEST(AllanVariance, OfWhiteNoiseFallsWithTheLengthThatIsAveraged) {
  const Eigen::VectorXd white = RandomMatrix("test.spectrum 5", 64000, 1);
  for (int length : {1, 4, 16}) {
    // Relative standard deviation of 64000 / length differences: sqrt(3 length / 64000), at most 0.027.
    EXPECT_NEAR(screen::AllanVariance({white}, length) * length, 1.0, 0.1) << length;
  }
}

TEST(AllanVariance, OfADriftIsHalfTheSquareOfWhatItGainsOverTheLength) {
  const Eigen::VectorXd drift = Eigen::VectorXd::LinSpaced(101, 0.0, 50.0);  // 0.5 a sample
  EXPECT_NEAR(screen::AllanVariance({drift}, 10), 0.5 * 5.0 * 5.0, 1e-12);
}

TEST(AllanVariance, IsUnknownWithoutTwoMeans) {
  EXPECT_TRUE(std::isnan(screen::AllanVariance({Eigen::VectorXd::Ones(19)}, 10)));
}

TEST(AllanVariance, DoesNotJoinSeriesThatStandApart) {
  EXPECT_EQ(screen::AllanVariance({Eigen::VectorXd::Constant(6, 1.0), Eigen::VectorXd::Constant(6, 9.0)}, 2), 0.0);
}

}  // namespace
}  // namespace twinbench::diagnose
