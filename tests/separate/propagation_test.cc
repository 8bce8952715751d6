#include <gtest/gtest.h>

#include <complex>

#include "tests/separate/bench.h"

namespace twinbench::separate {
namespace {

using Complex = std::complex<double>;

constexpr double kSigma_rad = 1e-6;

/// Equal, independent noise on ez, ex, ey [rad] and, in units of 1 m, on dy.
Matrix4 EqualNoise() {
  return kSigma_rad * kSigma_rad * Matrix4::Identity();
}

TableEstimate TargetOf(int n, const std::vector<int>& shifts, Clamping clamping, const BenchGeometry& geometry) {
  const auto motions = EmptyMotions(n, shifts, 1, EqualNoise());
  return Separator(motions, geometry, Options(n, clamping)).Separate(motions).target;
}

Eigen::MatrixXd BlockOf(const TableEstimate& estimate, Component component, int n) {
  const auto found = std::find(estimate.components.begin(), estimate.components.end(), component);
  const auto first = n * (found - estimate.components.begin());
  return estimate.cov.ToDense().block(first, first, n, n);
}

double Gain(const Eigen::MatrixXd& cov) {
  return std::sqrt(cov.trace() / static_cast<double>(cov.rows())) / kSigma_rad;
}

/// Variance of the k-th Fourier coefficient (1/n) sum x_i e^{-2 pi j k i / n}.
double HarmonicVariance(const Eigen::MatrixXd& cov, int k) {
  const auto n = static_cast<int>(cov.rows());
  Eigen::VectorXcd f(n);
  for (int i = 0; i < n; ++i) f[i] = std::polar(1.0 / n, 2 * units::kPi * k * i / n);
  return (f.adjoint() * cov.cast<Complex>() * f)(0, 0).real();
}

/// Formula (V) of docs/theory.md 2.
double ClosedForm(int n, const std::vector<int>& shifts, int k) {
  Complex a = 0.0;
  for (const int s : shifts) a += std::polar(1.0, 2 * units::kPi * k * s / n);
  const auto p = static_cast<double>(shifts.size());
  return kSigma_rad * kSigma_rad / n * p / (p * p - std::norm(a));
}

TEST(Separator, PropagatesTheNoiseOfEzAsTheClosedFormSays) {
  for (const auto& shifts : std::vector<std::vector<int>>{{0, 1}, {0, 1, 7, 11}}) {
    const Eigen::MatrixXd cov = BlockOf(TargetOf(36, shifts, Clamping::kReclamp, Bench()), Component::kEz, 36);
    for (int k = 1; k < 36; ++k) {
      EXPECT_NEAR(HarmonicVariance(cov, k) / ClosedForm(36, shifts, k), 1.0, 1e-6) << k;  // asked for by the task
    }
    EXPECT_LT(HarmonicVariance(cov, 0), 1e-12 * ClosedForm(36, shifts, 1));  // zero mean
  }
}

struct GainCase {
  int n;
  std::vector<int> shifts;
  double gain;
};

TEST(Separator, HasTheNoiseGainsOfTheShiftTables) {
  const std::vector<GainCase> cases = {{12, {0, 1}, 1.409},        {36, {0, 1}, 2.449},
                                       {72, {0, 1}, 3.464},        {12, {0, 1, 4}, 0.674},
                                       {12, {0, 1, 4, 6}, 0.531},  {36, {0, 1, 6}, 0.781},
                                       {36, {0, 1, 7, 11}, 0.579}, {36, {0, 1, 9, 11, 15}, 0.491}};
  for (const GainCase& c : cases) {
    const TableEstimate target = TargetOf(c.n, c.shifts, Clamping::kReseat, Bench());
    EXPECT_NEAR(Gain(BlockOf(target, Component::kEz, c.n)), c.gain, 6e-4) << c.n;  // three printed digits
  }
}

struct RadialCase {
  int n;
  std::vector<int> shifts;
  Clamping clamping;
  double gain;
};

TEST(Separator, HasTheNoiseGainsOfOneRadialComponent) {
  // Noise gains of an independent study, without levers; two digits are printed.
  const std::vector<RadialCase> cases = {
      {12, {0, 1}, Clamping::kReseat, 0.86},    {36, {0, 1}, Clamping::kReseat, 1.53},
      {12, {0, 1, 4}, Clamping::kReseat, 0.60}, {36, {0, 1, 9}, Clamping::kReclamp, 1.46},
      {36, {0, 1, 2}, Clamping::kReclamp, 7.0}, {36, {0, 1, 4, 12}, Clamping::kReclamp, 0.69}};
  for (const RadialCase& c : cases) {
    const TableEstimate target = TargetOf(c.n, c.shifts, c.clamping, FlatBench());
    EXPECT_NEAR(Gain(BlockOf(target, Component::kDy, c.n)), c.gain, c.gain > 2 ? 0.06 : 0.006) << c.n;
  }
}

TEST(Separator, UsesTheRankForItsDegreesOfFreedom) {
  const auto motions = EmptyMotions(12, {0, 1, 4}, 2, EqualNoise());
  const Separator separator(motions, Bench(), Options(12, Clamping::kReclamp));
  const int rank = separator.design().Unknowns() -
                   static_cast<int>(NullSpace(separator.design(), separator.separability().orders).cols());
  const Separation found = separator.Separate(motions);
  EXPECT_EQ(found.dof, 4 * 72 - rank);
  EXPECT_NEAR(found.dof_of.sum(), found.dof, 1e-6);  // rounding of traces
}

TEST(Separator, CarriesTheCalibrationIntoASystematicPart) {
  Stream stream(3, "test.truth");
  auto motions = EmptyMotions(12, {0, 1, 4}, 1, EqualNoise());
  FillExact(motions, RandomTruth(12, stream), Layouts(12, Clamping::kReseat), Bench());
  for (Motion& m : motions) m.d_calibration.col(0) = -m.Values();  // one gain that scales all four motions
  SeparateOptions options = Options(12, Clamping::kReseat);
  options.cov_calibration(0, 0) = 0.01 * 0.01;
  const Separation found = Separate(motions, Bench(), options);
  for (int i = 0; i < 12; ++i) {
    // 1 % of the value itself (second order: 1e-4 of it and of its neighbours).
    EXPECT_NEAR(std::sqrt(found.target.cov_systematic(i, i)),
                0.01 * std::abs(found.target.value[Component::kEx][static_cast<std::size_t>(i)]), 1e-9);
  }
}

}  // namespace
}  // namespace twinbench::separate
