#include "twin/diagnose/engine/series_sums.h"

#include "tests/diagnose/support/synthetic_run.h"
#include "tests/diagnose/encoder_fit.h"

// Sums of series that are never written out, against those of the series.
namespace twinbench::diagnose::encoder {
namespace {

using twinbench::test::EncoderScenario;

/// Two mountings, read in motion.
LinearRun SweepsOf(std::vector<Family>& families) {
  Scenario scenario = EncoderScenario("sweep");
  EncoderOf(scenario).encoder_procedure.mounting_rad = {0.0, 1.3};
  EncoderOf(scenario).encoder_procedure.interval_s = 1.8;
  const EncoderRun encoder =
      RunOf(twinbench::test::ReadingsWith(scenario, twinbench::test::EncoderEffect("periodic")), scenario);
  families = Families(encoder);
  return encoder.run;
}

Eigen::MatrixXd Dense(const Banded& T) {
  Eigen::MatrixXd dense = T.diagonal.asDiagonal();
  for (Eigen::Index k = 1; k <= std::ssize(T.beside); ++k) {
    const Eigen::VectorXd& beside = T.beside[static_cast<std::size_t>(k - 1)];
    dense.diagonal(k) = beside.head(beside.size() - k);
    dense.diagonal(-k) = beside.head(beside.size() - k);
  }
  return dense;
}

void ExpectSums(const Base& base, const std::string& name, const NoiseModel& noise, const LinearRun& run) {
  const auto sums = base.sums();
  const Eigen::MatrixXd Y = RandomMatrix("Y", run.Rows(), 2), products = sums->Products(Y);
  const Banded T = noise.Precision(run);
  const Eigen::MatrixXd dense = Dense(T);
  const std::vector<Eigen::MatrixXd> squares = sums->Squares(T);
  ASSERT_EQ(std::ssize(squares), base.grid);
  for (int g = 0; g < base.grid; g += 1 + base.grid / 20) {
    const Eigen::MatrixXd S = base.series(g), square = S.transpose() * dense * S;
    const double length = S.norm() * Y.norm();
    EXPECT_LT((products.middleRows(g * S.cols(), S.cols()) - S.transpose() * Y).norm(), 1e-11 * length)
        << name << g;
    EXPECT_LT((squares[static_cast<std::size_t>(g)] - square).norm(),
              1e-11 * S.squaredNorm() * T.diagonal.maxCoeff())
        << name << " " << g;
  }
}

TEST(SeriesSums, AreThoseOfTheSeriesThatAreNotWrittenOut) {
  std::vector<Family> families;
  const LinearRun run = SweepsOf(families);
  NoiseModel noise{run.sigma, {{0.4, -0.3, 0.2}}};
  for (int k = 0; k < run.Rows(); ++k) noise.sigma[k] *= 1.0 + 0.1 * (k % 7);
  std::set<std::string> seen;
  for (const Family& family : families) {
    if (!family.base || !family.base->sums) continue;
    ExpectSums(*family.base, family.effect, noise, run);
    seen.insert(family.effect);
  }
  for (const char* effect : {"periodic", "reference_fault", "slip", "line", "tone", "step", "touch",
                             "speed harmonic", "direction harmonic", "growing harmonic"})
    EXPECT_TRUE(seen.contains(effect)) << effect;
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
