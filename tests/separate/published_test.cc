#include "twin/benches/rotary_4dof/estimators/published.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/separate/bench.h"
#include "twin/core/errors.h"

namespace twinbench::separate {
namespace {

/// rms over the positions of the target's noise for unit noise on every reading.
double TargetGain(int n, bool least_squares) {
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  const auto solve = least_squares ? SolveTwoTestsLeastSquares : SolvePublished;
  const Eigen::MatrixXd map = solve(I.topRows(n), I.bottomRows(n));
  const Eigen::MatrixXd centred = map.topRows(n).rowwise() - map.topRows(n).colwise().mean();
  return std::sqrt(centred.squaredNorm() / n);
}

TEST(SolvePublished, RecoversScalarErrorsOfZeroSum) {
  const int n = 7;
  Eigen::VectorXd t(n), r(n), next(n);
  t << 3, -1, 4, -1, 5, -9, 2;
  r << 2, -7, 1, 8, -2, -8, 6;
  for (int i = 0; i < n; ++i) next[i] = r[(i + 1) % n];
  const Eigen::MatrixXd found = SolvePublished(t + r, t + next);
  EXPECT_LT((found.topRows(n) - t).norm() + (found.bottomRows(n) - r).norm(), 1e-12);  // rounding
}

TEST(SolvePublished, IsRootTwoNoisierThanLeastSquares) {
  for (const int n : {12, 36}) {
    // The dropped row is the closing difference of a random walk (docs/theory.md 2).
    EXPECT_NEAR(TargetGain(n, false) / TargetGain(n, true), std::sqrt(2.0), 1e-9) << n;
    EXPECT_NEAR(TargetGain(n, true), std::sqrt((n * n - 1.0) / (6.0 * n)), 1e-9) << n;
  }
}

constexpr Component kWobble[] = {Component::kEx, Component::kEy};

Truth ReferenceHarmonic(int n, int k) {
  Truth truth{ZeroErrors(n), ZeroErrors(n)};
  for (std::size_t j = 0; j < truth.reference.position_rad.size(); ++j) {
    truth.reference[Component::kEx][j] = 1e-7 * std::cos(k * truth.reference.position_rad[j]);
    truth.reference[Component::kEy][j] = 1e-7 * std::sin(k * truth.reference.position_rad[j]);
  }
  return truth;
}

/// rms of the wobble error of the target, of an amplitude of 1.
double WobbleError(int n, int k, Clamping clamping) {
  auto motions = EmptyMotions(n, {0, 1}, 1, ReadingCovariance());
  FillExact(motions, ReferenceHarmonic(n, k), Layouts(n, clamping), Bench());
  const Separation found = SeparatePublished(motions, Bench(), Layouts(n, clamping));
  double sum = 0.0;
  for (const Component c : kWobble) {
    for (const double v : found.target.value[c]) sum += v * v;
  }
  return std::sqrt(sum / n) / 1e-7;
}

TEST(SeparatePublished, GetsReferenceWobbleWrongByOneOverItsOrderAfterReclampingAndIsRightAfterReseating) {
  const std::vector<std::pair<int, double>> expected = {{1, 1.00}, {2, 0.502}, {3, 0.337}, {5, 0.206}, {10, 0.114}};
  for (const auto& [k, relative] : expected) {
    for (const int sign : {1, -1}) {
      // Three printed digits (docs/theory.md 3.1); wobble of 1e-7 rad keeps second order away.
      EXPECT_NEAR(WobbleError(36, sign * k, Clamping::kReclamp), relative, 6e-4) << sign * k;
    }
  }
  for (const int k : {1, 2, 5, -3}) EXPECT_LT(WobbleError(36, k, Clamping::kReseat), 1e-6);  // second order
}

TEST(SeparatePublished, AgreesWithTheTruthOfAScalarWorld) {
  const ExactCircles c = ReadExactly(36, {0, 1}, Clamping::kReseat, 2, FlatBench());
  const Separation found = SeparatePublished(c.motions, FlatBench(), Layouts(36, Clamping::kReseat));
  for (const test::SeparatedTable& t : test::BothTables(found, c.truth)) {
    // Second order of 5 arcsec wobble, amplified by up to n / pi: 1e-3 arcsec; the limit leaves a factor of 20.
    for (const Component k : {Component::kEx, Component::kEy, Component::kEz})
      EXPECT_LT(t.RmsError(k), 0.02 * units::arcsec) << t.Name(k);
  }
}

TEST(SeparatePublished, StatesTheNoiseOfItsElimination) {
  const auto motions = EmptyMotions(36, {0, 1}, 1, Matrix4::Identity());
  const Separation found = SeparatePublished(motions, Bench(), Layouts(36, Clamping::kReseat));
  double sum = 0.0;
  for (const double u : found.target.u[Component::kEx]) sum += u * u;
  // Means removed before the elimination: the closing difference is spread, the random walk becomes a bridge.
  EXPECT_GT(std::sqrt(sum / 36.0), 2.4);
  EXPECT_LT(std::sqrt(sum / 36.0), 3.47);
}

TEST(SeparatePublished, NeedsTwoSetUpsOneStepApart) {
  const auto motions = EmptyMotions(12, {0, 4}, 1, Matrix4::Identity());
  EXPECT_THROW(SeparatePublished(motions, Bench(), Layouts(12, Clamping::kReseat)), InputError);
}

}  // namespace
}  // namespace twinbench::separate
