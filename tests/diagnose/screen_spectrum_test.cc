#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"
#include "twin/diagnose/screen/estimators.h"

namespace twinbench::diagnose {
namespace {

Eigen::VectorXd Normals(int count, std::uint64_t seed) {
  Stream stream(seed, "test.spectrum");
  Eigen::VectorXd values(count);
  for (double& v : values) v = stream.Normal();
  return values;
}

/// Uneven: steps between 1 and 3.
Eigen::VectorXd Times_s(int count) {
  Stream stream(1, "test.times");
  Eigen::VectorXd time_s(count);
  for (int i = 0; i < count; ++i) time_s[i] = (i > 0 ? time_s[i - 1] : 100.0) + 1.0 + 2.0 * stream.Uniform();
  return time_s;
}

TEST(Spectrum, AgreesWithSumsOverUnevenTimes) {
  const Eigen::VectorXd time_s = Times_s(300);
  Eigen::MatrixXd series(300, 2);
  series << Normals(300, 2), Normals(300, 3);
  const double step_Hz = 0.5 / (time_s[299] - time_s[0]);
  const Eigen::MatrixXcd spectrum = screen::Spectrum(time_s, series, step_Hz, 250);
  for (int k = 1; k <= 250; ++k) {
    for (int j = 0; j < 2; ++j) {
      std::complex<double> sum = 0.0;
      for (int i = 0; i < 300; ++i)
        sum += series(i, j) * std::polar(1.0, -2.0 * units::kPi * k * step_Hz * (time_s[i] - time_s[0]));
      // Six digits of the largest possible sum, root of readings times the norm: 300.
      EXPECT_LT(std::abs(spectrum(k - 1, j) - sum), 300e-6) << k;
    }
  }
}

TEST(Spectrum, AgreesWhereTheStepsWrapAroundTheRun) {
  const Eigen::VectorXd time_s = Times_s(50), series = Normals(50, 2);
  const double step_Hz = 3.3 / (time_s[49] - time_s[0]);
  const Eigen::MatrixXcd spectrum = screen::Spectrum(time_s, series, step_Hz, 4);
  for (int k = 1; k <= 4; ++k) {
    std::complex<double> sum = 0.0;
    for (int i = 0; i < 50; ++i)
      sum += series[i] * std::polar(1.0, -2.0 * units::kPi * k * step_Hz * (time_s[i] - time_s[0]));
    EXPECT_LT(std::abs(spectrum(k - 1, 0) - sum), 50e-6) << k;
  }
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
    const auto tests = ScreenAsStated(run, 100, 1);
    const ScreenTest* tone = Find(tests, "time: tone");
    ASSERT_NE(tone, nullptr);
    EXPECT_LT(tone->p, 0.01) << period_s;
    EXPECT_NE(tone->reading.find("in tilt"), std::string::npos) << tone->reading;
    const auto at = tone->reading.find("period ");
    ASSERT_NE(at, std::string::npos) << tone->reading;
    // Steps of half a cycle over the run: the nearest is a quarter away, or two where noise decides between
    // neighbours.
    const double duration_s = time_s[time_s.size() - 1] - time_s[0];
    EXPECT_NEAR(duration_s / std::stod(tone->reading.substr(at + 7)), duration_s / period_s, 0.8);
    // Amplitude of 1152 readings on two channels: 0.3 um / sqrt(1152) = 0.009 um; a quarter cycle off takes 10 %.
    EXPECT_NEAR(tone->effect_m, 0.12e-6, 0.04e-6);
  }
}

TEST(AllanVariance, OfWhiteNoiseFallsWithTheLengthThatIsAveraged) {
  const Eigen::VectorXd white = Normals(64000, 5);
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
