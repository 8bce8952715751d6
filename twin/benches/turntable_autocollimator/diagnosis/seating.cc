#include "twin/benches/turntable_autocollimator/diagnosis/seating.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/turntable_autocollimator/diagnosis/outliers.h"
#include "twin/benches/turntable_autocollimator/format.h"
#include "twin/diagnose/engine/candidates.h"
#include "twin/diagnose/engine/estimate.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::turntable {
namespace {

constexpr double kFewestDof = 12.0;  // degrees of freedom of an axis

/// Squares of what is left and the degrees of freedom they have, of x and of y.
struct Squares {
  double x = 0.0, n_x = 0.0;
  double y = 0.0, n_y = 0.0;
  double neighbours = 0.0;  // products of x of neighbouring readings, as a normal score
};

/// Stated noise, without the readings that the analysis found disturbed.
NoiseModel Undisturbed(const LinearRun& run, const Analysis& analysis) {
  NoiseModel noise{run.sigma, {}};
  for (const NoiseCause& repair : analysis.repairs) {
    for (const int row : repair.outliers) noise.sigma[row] *= 1e4;
  }
  return noise;
}

bool IsNext(const Schedule& s, int i) {
  const auto a = static_cast<std::size_t>(i), b = a + 1;
  return i + 1 < s.Readings() && s.setup[a] == s.setup[b] && s.pass[a] == s.pass[b] && s.phase[a] == s.phase[b];
}

double NeighboursScore(const TurntableRun& turntable, const Eigen::VectorXd& left) {
  double products = 0.0, squares = 0.0;
  for (int i = 0; i < turntable.run.schedule.Readings(); ++i) {
    const int row = kAxes * i + kX;
    if (!IsNext(turntable.run.schedule, i)) continue;
    const double product = left[row] * left[row + kAxes];
    products += product;
    squares += product * product;
  }
  return squares > 0.0 ? products / std::sqrt(squares) : 0.0;
}

Squares SquaresOf(const TurntableRun& turntable, const Analysis& analysis) {
  const LinearRun& run = turntable.run;
  const NoiseModel noise = Undisturbed(run, analysis);
  const Projector projector(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  const Deflation terms(projector, noise.Whiten(run, Signatures(run, analysis.found.terms)));
  const Eigen::MatrixXd white = noise.Whiten(run, Eigen::MatrixXd(run.residual));
  const Eigen::VectorXd left = Project(projector, terms, white).rows.col(0), redundancy = projector.Redundancy();
  Squares squares;
  for (int row = 0; row < run.Rows(); ++row) {
    const bool is_x = row % kAxes == kX;
    const double n = redundancy[row] - (terms.Rank() > 0 ? terms.Basis().row(row).squaredNorm() : 0.0);
    (is_x ? squares.x : squares.y) += left[row] * left[row];
    (is_x ? squares.n_x : squares.n_y) += n;
  }
  squares.neighbours = NeighboursScore(turntable, left);
  return squares;
}

/// Averaged over the ratio of variances, 1 + r, that x has beside y; r even in the logarithm. The
/// factor that all share is integrated out, with the same trust in the stated noise as everywhere (Scanner).
double LogBayes(const Squares& s, double nu) {
  constexpr int kSteps = 40;
  const double half = 0.5 * (nu + s.n_x + s.n_y), all = nu + s.x + s.y;
  double sum = 0.0;
  for (const double r : Ratios(0.02, 400.0, kSteps)) {
    const double power = nu + s.x / (1.0 + r) + s.y;
    sum += std::exp(std::min(600.0, -0.5 * s.n_x * std::log1p(r) - half * std::log(power / all)));
  }
  return std::log(sum / kSteps);
}

ParameterEstimate Scatter(double scatter_rad, double u_rad) {
  return Catalogue(benches::turntable::Format().effects)
      .Estimate("multitooth_seating", "scatter", scatter_rad, u_rad);
}

double VarianceOfX(const TurntableRun& turntable) {
  LinearRun x;
  x.sigma = turntable.run.sigma(Eigen::seq(kX, Eigen::last, kAxes));
  return std::pow(UsualSigma_rad(x), 2);
}

}  // namespace

Seating MeasureSeating(const TurntableRun& turntable, const Analysis& analysis) {
  Seating seating;
  const Squares s = SquaresOf(turntable, analysis);
  if (turntable.run.noise_free || s.n_x < kFewestDof || s.n_y < kFewestDof) return seating;
  const double nu = PseudoDegrees(turntable.run), variance = VarianceOfX(turntable);
  const double common = (nu + s.y) / (nu + s.n_y), own = s.x / s.n_x;
  const double u_excess = std::hypot(own * std::sqrt(2.0 / s.n_x), common * std::sqrt(2.0 / (nu + s.n_y)));
  constexpr double kBaarda = 4.13;  // as for every other cause
  seating.smallest_rad =
      std::sqrt(variance * kBaarda * common * std::hypot(std::sqrt(2.0 / s.n_x), std::sqrt(2.0 / (nu + s.n_y))));
  constexpr double kCorrelated = 4.0;
  if (own <= common || s.neighbours > kCorrelated) return seating;
  seating.log_bayes = LogBayes(s, nu);
  seating.scatter_rad = std::sqrt(variance * (own - common));
  seating.u_scatter_rad = 0.5 * variance * u_excess / seating.scatter_rad;
  return seating;
}

Cause SeatingCause(const Seating& seating) {
  Cause cause;
  cause.effect = "multitooth_seating";
  cause.probability = tuning::kListed;
  cause.log_evidence = seating.log_bayes;
  cause.rho = std::sqrt(2.0 * std::max(0.0, seating.log_bayes));
  cause.parameters = {Scatter(seating.scatter_rad, seating.u_scatter_rad)};
  return cause;
}

Detectable DetectableSeating(double smallest_rad) {
  return {"multitooth_seating", "", Scatter(smallest_rad, kNaN)};
}

LinearRun WithScatter(const TurntableRun& turntable, double scatter_rad) {
  LinearRun run = turntable.run;
  for (int row = 0; row < run.Rows(); ++row) {
    if (row % kAxes == kX) run.sigma[row] = std::hypot(run.sigma[row], scatter_rad);
  }
  return run;
}

}  // namespace twinbench::diagnose::turntable
