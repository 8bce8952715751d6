#include "twin/model/wave_sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/units.h"

namespace twinbench::model {
namespace {

using diagnose::RandomMatrix;

/// Against a sine a reading a wave. Phases of some 1e4 rad have no more than 12 digits.
void ExpectDirectSums(const Eigen::VectorXd& phase_rad, double first, double step, int count) {
  Eigen::MatrixXd y(phase_rad.size(), 2);
  y << RandomMatrix("y", phase_rad.size(), 1), Eigen::VectorXd::Ones(phase_rad.size());
  const Eigen::MatrixXcd sums = WaveSums(phase_rad, first, step, count).Of(y);
  ASSERT_EQ(sums.rows(), count);
  const Eigen::RowVectorXd sizes = y.cwiseAbs().colwise().sum();
  for (int g = 0; g < count; g += 1 + count / 40) {
    for (int j = 0; j < 2; ++j) {
      std::complex<double> direct = 0.0;
      for (Eigen::Index i = 0; i < y.rows(); ++i)
        direct += y(i, j) * std::polar(1.0, (first + g * step) * phase_rad[i]);
      EXPECT_LT(std::abs(sums(g, j) - direct), 1e-11 * sizes[j]) << "wave " << g << " of " << count;
    }
  }
}

constexpr int kReadings = 500;

TEST(WaveSums, AreThoseOfEvenPhases) {
  const Eigen::VectorXd turn_rad = Eigen::VectorXd::LinSpaced(kReadings, 0.0, 2.0 * units::turn);
  for (const int count : {1, 2, 24, 720}) ExpectDirectSums(turn_rad, 1.0, 1.0, count);
}

TEST(WaveSums, AreThoseOfUnevenPhasesOfManyTurnsEitherWay) {
  const Eigen::VectorXd phase_rad = 20.0 * RandomMatrix("phase", kReadings, 1);
  ExpectDirectSums(phase_rad, 0.3, 0.013, 1500);
  ExpectDirectSums(phase_rad, -40.0, 1.0, 81);
}

TEST(WaveSums, AreThoseOfPhasesThatLieTogether) {
  Eigen::VectorXd phase_rad = 1e-6 * RandomMatrix("phase", kReadings, 1);
  phase_rad.tail(kReadings / 2).array() += units::turn;  // the end of the grid and its beginning are neighbours
  for (const int count : {3, 100}) ExpectDirectSums(phase_rad, 1.0, 1.0, count);
}

TEST(WaveSums, OfOneReadingAreItsWaves) {
  ExpectDirectSums(Eigen::VectorXd::Constant(1, 0.7), 2.0, 1.0, 30);
}

}  // namespace
}  // namespace twinbench::model
