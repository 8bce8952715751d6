#include <Eigen/QR>
#include <complex>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/bundle.h"
#include "twin/diagnose/engine/known_products.h"
#include "twin/diagnose/engine/scan_kernels.h"
#include "twin/diagnose/engine/vector_math.h"
#include "twin/model/wave_sums.h"

namespace twinbench::diagnose {
namespace {

constexpr int kBlocks = 7, kSize = 2, kCore = 9, kRows = 120;

/// Every row touches one local block and the whole core; two core columns are equal, so only the prior parts them.
Nuisance ArrowNuisance() {
  const Eigen::MatrixXd values = RandomMatrix("jacobian", kRows, kSize + kCore);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kRows, kBlocks * kSize + kCore);
  for (int k = 0; k < kRows; ++k) {
    dense.row(k).segment((k % kBlocks) * kSize, kSize) = values.row(k).head(kSize);
    dense.row(k).tail(kCore) = values.row(k).tail(kCore);
  }
  dense.rightCols(1) = dense.middleCols(kBlocks * kSize, 1);
  return {.jacobian = dense.sparseView(), .prior_precision = Eigen::VectorXd::Constant(dense.cols(), 1e-4),
          .blocks = kBlocks, .block_size = kSize};
}

/// The same by an orthogonal factorisation of the data with the priors as extra rows.
Eigen::MatrixXd ApplyDense(const Nuisance& nuisance, const Eigen::MatrixXd& Y) {
  const Eigen::MatrixXd J = nuisance.jacobian;
  Eigen::MatrixXd stacked(J.rows() + J.cols(), J.cols());
  stacked << J, Eigen::MatrixXd(nuisance.prior_precision.cwiseSqrt().asDiagonal());
  Eigen::MatrixXd data = Eigen::MatrixXd::Zero(stacked.rows(), Y.cols());
  data.topRows(Y.rows()) = Y;
  return Y - J * stacked.householderQr().solve(data);
}

// Also where rows touch two blocks: taking each row's neighbour out, as noise that is correlated from reading to
// reading asks for, joins them.
TEST(Projector, AgreesWithAnOrthogonalFactorisationOfAllUnknowns) {
  for (const double neighbour : {0.0, 0.4}) {
    Nuisance nuisance = ArrowNuisance();
    const Eigen::MatrixXd J = nuisance.jacobian;
    Eigen::MatrixXd joined = J;
    joined.bottomRows(kRows - 1) -= neighbour * J.topRows(kRows - 1);
    nuisance.jacobian = joined.sparseView();
    const Eigen::MatrixXd Y = RandomMatrix("data", kRows, 5);
    const Projector projector(nuisance.jacobian, nuisance);
    EXPECT_LT((projector.Apply(Y) - ApplyDense(nuisance, Y)).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(Projector, GivesTheQuadraticFormWithoutFormingTheProjection) {
  const Nuisance nuisance = ArrowNuisance();
  const Projector projector(nuisance.jacobian, nuisance);
  const Eigen::MatrixXd S = RandomMatrix("signatures", kRows, 3);
  const Eigen::MatrixXd H = projector.Absorbed(S);
  const Eigen::MatrixXd expected = S.transpose() * ApplyDense(nuisance, S);
  EXPECT_LT((S.transpose() * S - H.transpose() * H - expected).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Projector, CountsTheDegreesOfFreedomThatAreLeftAndRefusesAnUnknownWithoutPrior) {
  const Nuisance nuisance = ArrowNuisance();
  const Projector projector(nuisance.jacobian, nuisance);
  const Eigen::MatrixXd W = ApplyDense(nuisance, Eigen::MatrixXd::Identity(kRows, kRows));
  EXPECT_NEAR(projector.DegreesOfFreedom(), W.trace(), 1e-9);
  // 7 x 2 local and 9 core unknowns, of which two are the same: 22. The weak prior takes nearly nothing.
  EXPECT_NEAR(projector.DegreesOfFreedom(), kRows - 22.0, 1e-3);
  EXPECT_LT((projector.Redundancy() - W.diagonal()).cwiseAbs().maxCoeff(), 1e-9);
  Nuisance without_prior = nuisance;
  without_prior.prior_precision[3] = 0.0;
  EXPECT_THROW(Projector(nuisance.jacobian, without_prior), std::logic_error);
}

TEST(ScanKernels, ExponentialIsThatOfTheMathematicsLibrary) {
  for (double x = -699.0; x <= 0.0; x += 0.0917) EXPECT_NEAR(ExpOfNegative(x) / std::exp(x), 1.0, 1e-14) << x;
  EXPECT_EQ(ExpOfNegative(0.0), 1.0);
  EXPECT_LT(ExpOfNegative(-1e300), 1e-300);
}

TEST(ScanKernels, LogarithmIsThatOfTheMathematicsLibrary) {
  for (double x = 1e-12; x < 1e6; x *= 1.0173)
    EXPECT_NEAR(LogOfPositive(x), std::log(x), 2e-15 * (1.0 + std::abs(std::log(x)))) << x;
  for (const double x : {1.0 - 1e-9, 1.0 + 1e-9, 1.0 - 0x1p-53})
    EXPECT_NEAR(LogOfPositive(x) / std::log(x), 1.0, 1e-12) << x;
  EXPECT_EQ(LogOfPositive(1.0), 0.0);
}

TEST(ScanKernels, ProductIsThatOfMatricesOfAnySizeAndOfAPartOfOne) {
  for (const Eigen::Index rows : {1, 7, 8, 9, 40}) {
    const Eigen::MatrixXd A = RandomMatrix("scan_kernels", rows, 5), B = RandomMatrix("scan_kernels", rows, 11);
    const Eigen::MatrixXd product = TransposedProduct(A, B), expected = A.transpose() * B;
    EXPECT_LT((product - expected).cwiseAbs().maxCoeff(), 1e-13) << rows;
  }
  const Eigen::MatrixXd A = RandomMatrix("scan_kernels", 20, 6), B = RandomMatrix("scan_kernels", 13, 4);
  const Eigen::MatrixXd product = TransposedProduct(A.block(2, 1, 13, 3), B);
  EXPECT_LT((product - A.block(2, 1, 13, 3).transpose() * B).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(ScanKernels, MeanOfExponentialsDoesNotOverflow) {
  const Eigen::ArrayXd first{{-1000.0, 900.0, 3.0}}, second{{-1001.0, 900.0, -500.0}};
  LogMean mean(3);
  mean.Add(first);
  mean.Add(second);
  const Eigen::ArrayXd value = mean.Value();
  EXPECT_NEAR(value[0], -1000.0 + std::log(0.5 * (1.0 + std::exp(-1.0))), 1e-12);
  EXPECT_NEAR(value[1], 900.0, 1e-12);
  EXPECT_NEAR(value[2], 3.0 - std::log(2.0), 1e-12);
}

TEST(ScanKernels, LogBayesFactorIsItsFormula) {
  const RunsByRow c2 = RandomMatrix("scan_kernels", 2, 9).array().square();
  const Eigen::VectorXd weight{{0.4, 0.9}};
  const Eigen::ArrayXd power = Eigen::ArrayXd::LinSpaced(9, 0.5, 30.0);  // the first leave nothing
  Eigen::ArrayXd log_bayes;
  LogBayesOf(weight, c2, power, 0.7, 25.0, log_bayes);
  for (Eigen::Index k = 0; k < 9; ++k) {
    const double left = 1.0 - (0.4 * c2(0, k) + 0.9 * c2(1, k)) / power[k];
    EXPECT_NEAR(log_bayes[k], -0.7 - 25.0 * std::log(std::max(left, 1e-12)), 1e-11) << k;
  }
}

constexpr int kGrid = 40, kSeries = 3;

/// Correlated noise of unequal size.
NoiseModel UnevenNoise(const LinearRun& run) {
  NoiseModel noise{run.sigma, {{0.3}}};
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
  const Projector projector = ProjectorOf(run, noise);
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

TEST(Bundle, MultipliesSeriesWithoutWritingThemOutSignaturesOfAFamilyOfItsOwnAndWhatItMayNotKeep) {
  for (const Eigen::Index kept : {1'000'000'000, 10'000, 0}) ExpectProducts(true, kept);
  ExpectProducts(false, 1'000'000'000);
}

TEST(Bundle, TakesNoMoreMemoryThanGranted) {
  const LinearRun run = SyntheticRun({});
  const NoiseModel noise = UnevenNoise(run);
  const Projector projector = ProjectorOf(run, noise);
  const std::vector<Family> families = {SomeFamily(run, true)};
  Eigen::Index left = 10'000;
  const Bundle bundle(run, noise, projector, families, {0}, left);
  EXPECT_GE(left, 0);
  EXPECT_LT(left, 10'000);
}

TEST(KnownProducts, AreThoseOfColumnsThatComeAgainInAnotherOrder) {
  const LinearRun run = SyntheticRun({});
  const NoiseModel noise = UnevenNoise(run);
  const Projector projector = ProjectorOf(run, noise);
  const std::vector<Family> families = {SomeFamily(run, true), SomeFamily(run, false)};
  std::vector<Bundle> bundles;
  Eigen::Index kept = 1'000'000'000;
  for (int k = 0; k < 2; ++k) bundles.emplace_back(run, noise, projector, families, std::vector{k}, kept);
  KnownProducts known(run, noise, bundles);
  const Eigen::MatrixXd white = RandomMatrix("white", run.Rows(), 5);
  known.Of(white.leftCols(3));
  const Eigen::MatrixXd again = white(Eigen::all, std::vector{4, 1, 3, 0, 1});
  const std::vector<RunsByRow> products = known.Of(again);
  ASSERT_EQ(products.size(), 2u);
  const Unwhitened Y(run, noise, again);
  for (std::size_t b = 0; b < 2; ++b) {
    for (int g = 0; g < kGrid; ++g) {
      const Bundle& bundle = bundles[b];
      const Eigen::MatrixXd direct =
          bundle.Products(g / bundle.Step(), Y).middleRows((g % bundle.Step()) * bundle.Columns(), bundle.Columns());
      EXPECT_LT((products[b].middleRows(g * bundle.Columns(), bundle.Columns()) - direct).norm(), 1e-12 * direct.norm())
          << b << " " << g;
    }
  }
}

/// Against a sine a reading a wave. Phases of some 1e4 rad have no more than 12 digits.
void ExpectDirectSums(const Eigen::VectorXd& phase_rad, double first, double step, int count) {
  Eigen::MatrixXd y(phase_rad.size(), 2);
  y << RandomMatrix("y", phase_rad.size(), 1), Eigen::VectorXd::Ones(phase_rad.size());
  const Eigen::MatrixXcd sums = model::WaveSums(phase_rad, first, step, count).Of(y);
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

constexpr int kPhases = 500;

TEST(WaveSums, AreThoseOfPhasesThatLieEvenlyUnevenlyOverManyTurnsEitherWayOrTogether) {
  const Eigen::VectorXd even_rad = Eigen::VectorXd::LinSpaced(kPhases, 0.0, 2.0 * units::turn),
                        uneven_rad = 20.0 * RandomMatrix("phase", kPhases, 1);
  Eigen::VectorXd together_rad = 1e-6 * RandomMatrix("phase", kPhases, 1);
  together_rad.tail(kPhases / 2).array() += units::turn;  // the end of the grid and its beginning are neighbours
  for (const int count : {1, 2, 24, 720}) ExpectDirectSums(even_rad, 1.0, 1.0, count);
  ExpectDirectSums(uneven_rad, 0.3, 0.013, 1500);
  ExpectDirectSums(uneven_rad, -40.0, 1.0, 81);
  for (const int count : {3, 100}) ExpectDirectSums(together_rad, 1.0, 1.0, count);
  ExpectDirectSums(Eigen::VectorXd::Constant(1, 0.7), 2.0, 1.0, 30);  // of one reading
}

}  // namespace
}  // namespace twinbench::diagnose
