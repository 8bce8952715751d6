#include "twin/diagnose/scatter_cause.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "twin/core/distributions.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/engine/candidates.h"
#include "twin/diagnose/engine/estimate.h"
#include "twin/diagnose/same_pass.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

constexpr double kFewestDof = 12.0;  // degrees of freedom of the rows that show it, and of the others

/// Squares of what is left and the degrees of freedom that they have.
struct Squares {
  double shown = 0.0, n_shown = 0.0;  // of rows that show the point
  double other = 0.0, n_other = 0.0;
  double neighbours = 0.0;  // products of neighbouring readings that show it, as a normal score
};

/// Stated noise, without the readings that the analysis found disturbed.
NoiseModel Undisturbed(const LinearRun& run, const Analysis& analysis) {
  NoiseModel noise{run.sigma, {}};
  for (const NoiseCause& repair : analysis.repairs) {
    for (const int row : repair.outliers) noise.sigma[row] *= 1e4;
  }
  return noise;
}

double NeighboursScore(const LinearRun& run, const Eigen::ArrayX<bool>& shows, const Eigen::VectorXd& left) {
  double products = 0.0, squares = 0.0;
  for (int row = 0; row < run.Rows(); ++row) {
    if (!shows[row] || !HasNext(run.schedule, run.ReadingOf(row))) continue;
    const double product = left[row] * left[row + run.Channels()];
    products += product;
    squares += product * product;
  }
  return squares > 0.0 ? products / std::sqrt(squares) : 0.0;
}

Squares SquaresOf(const LinearRun& run, const Analysis& analysis, const Eigen::ArrayX<bool>& shows) {
  const NoiseModel noise = Undisturbed(run, analysis);
  const Projector projector(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  const Deflation terms(projector, noise.Whiten(run, Signatures(run, analysis.found.terms)));
  const Eigen::MatrixXd white = noise.Whiten(run, Eigen::MatrixXd(run.residual));
  const Eigen::VectorXd left = Project(projector, terms, white).rows.col(0);
  const Eigen::VectorXd n = projector.Redundancy() - terms.BasisOf(run.Rows()).rowwise().squaredNorm();
  const Eigen::VectorXd shown = shows.cast<double>(), other = 1.0 - shown.array();
  const Eigen::VectorXd left2 = left.cwiseAbs2();
  return {shown.dot(left2), shown.dot(n), other.dot(left2), other.dot(n), NeighboursScore(run, shows, left)};
}

/// Averaged over the ratio of variances, 1 + r, that rows have which show it; r even in the logarithm. The factor
/// that all share is integrated out, with the same trust in the stated noise as everywhere (Scanner).
double LogBayes(const Squares& s, double nu) {
  constexpr int kSteps = 40;
  const double half = 0.5 * (nu + s.n_shown + s.n_other), all = nu + s.shown + s.other;
  double sum = 0.0;
  for (const double r : Ratios(0.02, 400.0, kSteps)) {
    const double power = nu + s.shown / (1.0 + r) + s.other;
    sum += std::exp(std::min(600.0, -0.5 * s.n_shown * std::log1p(r) - half * std::log(power / all)));
  }
  return std::log(sum / kSteps);
}

/// Of a reading that shows the point, SI of the point.
double UsualVariance(const LinearRun& run, const Eigen::ArrayX<bool>& shows, const Eigen::VectorXd& slope) {
  std::vector<double> sigma;
  for (int row = 0; row < run.Rows(); ++row)
    if (shows[row]) sigma.push_back(run.sigma[row] / std::abs(slope[row]));
  return std::pow(Median(sigma), 2);
}

ParameterEstimate Told(const TwinComparison& comparison, double sd, double u) {
  const TwinComparison::ScatterCause& cause = *comparison.scatter_cause;
  return Catalogue(comparison.format->effects).Estimate(cause.effect, cause.parameter, sd, u);
}

}  // namespace

Scattering MeasureScatter(const LinearRun& run, const Analysis& analysis, const Eigen::VectorXd& slope) {
  constexpr double kShows = 0.5, kCorrelated = 4.0;
  Scattering scattering;
  const Eigen::ArrayX<bool> shows = slope.array().abs() > kShows * slope.cwiseAbs().maxCoeff();
  const Squares s = SquaresOf(run, analysis, shows);
  if (run.noise_free || s.n_shown < kFewestDof || s.n_other < kFewestDof) return scattering;
  const double nu = PseudoDegrees(run), variance = UsualVariance(run, shows, slope);
  const double common = (nu + s.other) / (nu + s.n_other), own = s.shown / s.n_shown;
  const double u_shown = std::sqrt(2.0 / s.n_shown), u_other = std::sqrt(2.0 / (nu + s.n_other));
  scattering.smallest = std::sqrt(variance * tuning::kBaarda * common * std::hypot(u_shown, u_other));
  if (own <= common || s.neighbours > kCorrelated) return scattering;
  scattering.log_bayes = LogBayes(s, nu);
  scattering.sd = std::sqrt(variance * (own - common));
  scattering.u_sd = 0.5 * variance * std::hypot(own * u_shown, common * u_other) / scattering.sd;
  return scattering;
}

Cause CauseOf(const Scattering& scattering, const TwinComparison& comparison) {
  Cause cause = DecidedCause(comparison.scatter_cause->effect, "", scattering.log_bayes);
  cause.parameters = {Told(comparison, scattering.sd, scattering.u_sd)};
  return cause;
}

Detectable DetectableOf(const Scattering& scattering, const TwinComparison& comparison) {
  return {comparison.scatter_cause->effect, "", Told(comparison, scattering.smallest, kNaN)};
}

}  // namespace twinbench::diagnose
