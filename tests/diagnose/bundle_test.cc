#include "twin/diagnose/engine/bundle.h"

#include <gtest/gtest.h>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/stream.h"

namespace twinbench::diagnose {
namespace {

constexpr int kGrid = 40, kSeries = 3;

Eigen::MatrixXd RandomMatrix(const std::string& name, Eigen::Index rows, Eigen::Index columns) {
  Stream stream(5, name);
  Eigen::MatrixXd m(rows, columns);
  for (double& v : m.reshaped()) v = stream.Normal();
  return m;
}

/// Correlated noise of unequal size.
NoiseModel UnevenNoise(const LinearRun& run) {
  NoiseModel noise{run.sigma, 0.3};
  for (Eigen::Index k = 0; k < noise.sigma.size(); ++k) noise.sigma[k] *= 1.0 + 0.1 * static_cast<double>(k % 7);
  return noise;
}

/// Three series on each of the four channels; a family of its own if `shared` is false.
Family SomeFamily(const LinearRun& run, bool shared) {
  const auto series = [n = run.schedule.Readings()](int g) { return RandomMatrix(std::to_string(g), n, kSeries); };
  Family family;
  const int columns = run.Channels() * kSeries;
  family.amplitudes.assign(static_cast<std::size_t>(columns), {"amplitude", "um", 1e-6, 1e-6});
  family.grid = kGrid;
  const auto base = std::make_shared<Base>(Base{kGrid, run.Channels(), series});
  if (shared) {
    family.base = base;
    family.map = Eigen::MatrixXd::Identity(columns, columns);
  } else {
    family.columns = [base](int g) { return base->Columns(g); };
  }
  return family;
}

/// @param kept  Values that may be kept.
void ExpectProducts(bool shared, Eigen::Index kept) {
  const LinearRun run = SyntheticRun({});
  const NoiseModel noise = UnevenNoise(run);
  const Projector projector(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  const std::vector<Family> families = {SomeFamily(run, shared)};
  const Bundle bundle(run, noise, projector, families, {0}, kept);
  const Eigen::MatrixXd white = RandomMatrix("white", run.Rows(), 2);
  const Unwhitened Y(run, noise, white);
  for (int g = 0; g < kGrid; ++g) {
    const Eigen::MatrixXd S = noise.Whiten(run, families[0].ColumnsAt(g));
    const Eigen::MatrixXd products =
        bundle.Products(g / bundle.Step(), Y).middleRows((g % bundle.Step()) * bundle.Columns(), bundle.Columns());
    // Some 1e8: deviations are 1e-7 m and signatures of order one.
    EXPECT_LT((products - S.transpose() * white).norm(), 1e-12 * products.norm()) << g;
    EXPECT_LT((bundle.Gram(g) - S.transpose() * projector.Apply(S)).norm(), 1e-9 * bundle.Raw(g).norm()) << g;
  }
}

TEST(Bundle, MultipliesSeriesWithoutWritingThemOutOnEveryChannel) {
  ExpectProducts(true, 1'000'000'000);
}

TEST(Bundle, MultipliesSignaturesOfAFamilyOfItsOwn) {
  ExpectProducts(false, 1'000'000'000);
}

TEST(Bundle, MakesAgainWhatItMayNotKeep) {
  ExpectProducts(true, 0);
  ExpectProducts(true, 10'000);
}

TEST(Bundle, TakesNoMoreMemoryThanGranted) {
  const LinearRun run = SyntheticRun({});
  const NoiseModel noise = UnevenNoise(run);
  const Projector projector(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  const std::vector<Family> families = {SomeFamily(run, true)};
  Eigen::Index left = 10'000;
  const Bundle bundle(run, noise, projector, families, {0}, left);
  EXPECT_GE(left, 0);
  EXPECT_LT(left, 10'000);
}

}  // namespace
}  // namespace twinbench::diagnose
