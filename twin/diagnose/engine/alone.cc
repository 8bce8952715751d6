#include "twin/diagnose/engine/alone.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/answer.h"
#include "twin/diagnose/engine/posterior.h"
#include "twin/diagnose/engine/prior.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

/// Of a shape in a grid: the distance to the nearest other value. NaN if there is none.
double Resolution(const Shape& shape, double value) {
  const std::set<double> values(shape.value.begin(), shape.value.end());
  double nearest = kNaN;
  for (const double other : values) {
    if (other != value) nearest = std::fmin(nearest, std::abs(other - value));
  }
  return nearest;
}

/// A family at one point of its grid.
struct Fitted {
  Eigen::VectorXd shape, amplitudes;
  Eigen::MatrixXd cov;  // of the amplitudes, and of the shape after them
  double rho = 0.0;     // length of the signature, in units of noise
};

Fitted FittedAt(int grid_point, const Family& family, const LinearRun& run, const NoiseModel& noise,
                const Projector& projector, const Eigen::MatrixXd& projected) {
  constexpr double kWidestPrior = 4.0;  // prior deviations, as in the evidence
  const auto amplitudes = std::ssize(family.amplitudes), shapes = std::ssize(family.shapes);
  Eigen::VectorXd scale(amplitudes);
  for (Eigen::Index k = 0; k < amplitudes; ++k)
    scale[k] = kWidestPrior * family.amplitudes[static_cast<std::size_t>(k)].prior_sd;
  const Eigen::MatrixXd white = noise.Whiten(run, family.ColumnsAt(grid_point)) * scale.asDiagonal();
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(amplitudes, amplitudes);
  const Eigen::MatrixXd gram = white.transpose() * projector.Apply(white);
  const Eigen::MatrixXd normal = gram + one;
  const Eigen::VectorXd sizes = SolveSymmetric(normal, Eigen::VectorXd(white.transpose() * projected));
  Fitted fitted{family.ShapeAt(grid_point), scale.asDiagonal() * sizes,
                Eigen::MatrixXd::Zero(amplitudes + shapes, amplitudes + shapes),
                std::sqrt(std::max(0.0, sizes.dot(gram * sizes)))};
  fitted.cov.topLeftCorner(amplitudes, amplitudes) = scale.asDiagonal() * InverseOfSymmetric(normal) * scale.asDiagonal();
  for (Eigen::Index k = 0; k < shapes; ++k) {
    const Shape& shape = family.shapes[static_cast<std::size_t>(k)];
    fitted.cov(amplitudes + k, amplitudes + k) = std::pow(Resolution(shape, fitted.shape[k]), 2);
  }
  return fitted;
}

/// Families of each cause, in the order of the catalogue.
std::vector<std::vector<Eigen::Index>> VariantsOf(const std::vector<Family>& families) {
  std::map<CauseKey, std::size_t> place;
  std::vector<std::vector<Eigen::Index>> variants;
  for (std::size_t k = 0; k < families.size(); ++k) {
    if (families[k].kind != Kind::kNamed) continue;
    const auto [at, is_new] = place.try_emplace({families[k].effect, families[k].where}, variants.size());
    if (is_new) variants.emplace_back();
    variants[at->second].push_back(static_cast<Eigen::Index>(k));
  }
  return variants;
}

}  // namespace

std::vector<Cause> CausesAlone(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                               const Scanner& scanner, const Evidence& alone) {
  const std::vector<Family>& families = scanner.Families();
  const Eigen::VectorXd log_priors = LogPriors(families), logs = log_priors + alone.log_bayes.col(0);
  Eigen::VectorXd with_none(logs.size() + 1);
  with_none << logs, std::log(tuning::kPriorNone);
  const double all = LogSum(with_none);
  const Eigen::MatrixXd residual = run.residual, projected = projector.Apply(noise.Whiten(run, residual));
  std::vector<Cause> causes;
  for (const std::vector<Eigen::Index>& own : VariantsOf(families)) {
    const auto best = *std::ranges::max_element(own, {}, [&logs](Eigen::Index k) { return logs[k]; });
    const Family& family = families[static_cast<std::size_t>(best)];
    const Fitted fitted = FittedAt(alone.grid_point(best, 0), family, run, noise, projector, projected);
    const double weight = LogSum(logs(own));
    Cause cause;
    cause.effect = family.effect;
    cause.where = family.where;
    cause.probability = std::exp(weight - all);
    cause.log_evidence = weight - LogSum(log_priors(own));
    cause.rho = fitted.rho;
    cause.parameters = ParametersOf(family, fitted.shape, fitted.amplitudes, fitted.cov);
    causes.push_back(std::move(cause));
  }
  std::ranges::stable_sort(causes, std::ranges::greater{}, &Cause::probability);
  return causes;
}

}  // namespace twinbench::diagnose
