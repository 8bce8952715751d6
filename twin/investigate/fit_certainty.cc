#include "twin/investigate/fit_certainty.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "twin/core/happened_once.h"
#include "twin/core/linear_algebra.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::investigate {
namespace {

double Rows(std::span<const TakenRun> runs) {
  double rows = 0.0;
  for (const TakenRun& run : runs) rows += run.projector->DegreesOfFreedom();
  return rows;
}

/// Of what is left, noise known as well as tuning::kPseudoDegrees says.
double LogLikelihood(double chi2, double rows) {
  const double trust = diagnose::tuning::kPseudoDegrees;
  return -0.5 * (trust + rows) * std::log(trust + chi2);
}

/// Laplace's factor: how much of what was thought of the sizes before the readings leave.
double LogShareLeft(const Eigen::MatrixXd& normal, const Eigen::VectorXd& breadth) {
  if (breadth.size() == 0) return 0.0;
  const Eigen::MatrixXd widened = Eigen::MatrixXd::Identity(normal.rows(), normal.cols()) +
                                  breadth.asDiagonal() * normal * breadth.asDiagonal();
  return -CholeskyFactorOf(widened).diagonal().array().log().sum();
}

/// Sizes that the readings do not tell from one of their bounds.
std::vector<Eigen::Index> NearBounds(const Hypothesis& hypothesis, const std::vector<Size>& sizes,
                                     const Eigen::MatrixXd& cov) {
  constexpr double kNear = 2.0;  // standard uncertainties
  std::vector<Eigen::Index> near;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const double off = std::abs(ValueOf(hypothesis, sizes[k]) - BoundOf(hypothesis, sizes[k])) / sizes[k].u;
    if (sizes[k].name != kHappenedAt && off <= kNear * std::sqrt(cov(row, row))) near.push_back(row);
  }
  return near;
}

/// What the sizes that are `fixed` no longer say.
void Strike(const std::vector<Eigen::Index>& fixed, Normal& normal) {
  for (const Eigen::Index k : fixed) {
    normal.matrix.row(k).setZero();
    normal.matrix.col(k).setZero();
    normal.gradient[k] = 0.0;
    for (Eigen::MatrixXd& slopes : normal.slopes) slopes.col(k).setZero();
  }
}

/// chi2 of what is left when the sizes have followed it by their slopes.
double FollowedBy(const Left& left, const Normal& normal, const Eigen::VectorXd& breadth,
                  std::span<const TakenRun> runs) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(normal.gradient.size());
  for (std::size_t k = 0; k < runs.size(); ++k) gradient += Product(runs[k], normal.slopes[k], left.of[k]);
  return left.chi2 - gradient.dot(CovarianceOf(normal.matrix, breadth) * gradient);
}

/// What the readings leave of a size whose slopes do not say it.
struct Summed {
  double log_share = 0.0;  // of what was thought of it before
  double u = 0.0;          // root mean square of the distance from its fit, in units of u
};

/// Distances from a bound at which the likelihood of a size is looked at, ascending: ever finer towards the bound,
/// for nobody knows the scale of what begins there, and about the fit, which may be a peak between two of them.
/// @param off   Of the fit from the bound, in units of u.
/// @param wide  The fit's standard uncertainty by its slope; 0: it has none.
std::vector<double> Distances(double farthest, double off, double wide) {
  constexpr int kHalvings = 7;
  std::vector<double> distances = {0.0};
  for (int halving = kHalvings; halving >= 0; --halving) distances.push_back(std::ldexp(farthest, -halving));
  for (const double by : {-4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0}) {
    const double distance = off + by * wide;
    if (distance > 0.0 && distance < farthest) distances.push_back(distance);
  }
  std::ranges::sort(distances);
  distances.erase(std::unique(distances.begin(), distances.end()), distances.end());
  return distances;
}

/// Slopes say little of a size near a bound: a gap that is crossed at once looks the same up to the distance of two
/// readings, and like nothing beyond. So its likelihood is summed over distances, the other sizes following it by
/// their slopes, against half a normal distribution of its breadth.
/// @param wide  As Distances has it.
Summed SummedFrom(const Hypothesis& at, const Size& size, double breadth, double wide, double chi2,
                  const std::function<double(const Hypothesis&)>& chi2_of, double rows) {
  constexpr double kFarthest = 3.0, kGone = 12.0;  // of breadth; of log likelihood
  const double bound = BoundOf(at, size), room = (size.upper - size.lower) / size.u;
  const double from = (bound - ValueOf(at, size)) / size.u, sign = bound == size.lower ? 1.0 : -1.0;
  const double off = std::abs(from), best = LogLikelihood(chi2, rows);
  const auto likelihood_at = [&](double distance) {
    const Hypothesis moved = Moved(at, {size}, Eigen::VectorXd::Constant(1, from + sign * distance));
    return std::exp(std::min(0.0, LogLikelihood(chi2_of(moved), rows) - best));
  };
  const std::vector<double> distances = Distances(std::min(room, kFarthest * breadth), off, wide);
  double before = 0.0, mass = 0.0, thought = 0.0, squares = 0.0, last = likelihood_at(0.0);
  for (std::size_t k = 1; k < distances.size(); ++k) {
    const double distance = distances[k];
    const double likelihood = distance > off && last < std::exp(-kGone) ? 0.0 : likelihood_at(distance);
    const double prior_before = std::exp(-0.5 * std::pow(before / breadth, 2)),
                 prior = std::exp(-0.5 * std::pow(distance / breadth, 2)), step = 0.5 * (distance - before);
    thought += step * (prior_before + prior);
    mass += step * (prior_before * last + prior * likelihood);
    squares +=
        step * (std::pow(before - off, 2) * prior_before * last + std::pow(distance - off, 2) * prior * likelihood);
    before = distance;
    last = likelihood;
  }
  if (!(mass > 0.0)) return {-kGone, 0.0};
  return {std::log(mass / thought), std::sqrt(squares / mass)};
}

/// What happens at one reading may have done so at any of its run, each as likely as the others beforehand: the
/// likelihood is summed over them, by trapezoids of doubling width, the other sizes following by their slopes.
Summed SummedOverReadings(const Hypothesis& at, const Size& size, double chi2,
                          const std::function<double(const Hypothesis&)>& chi2_of, double rows, double readings) {
  constexpr double kGone = 12.0;             // of log likelihood
  constexpr double kWithinOne = 1.0 / 12.0;  // variance: between two readings it may have been anywhere
  const double best = LogLikelihood(chi2, rows), value = ValueOf(at, size);
  double sum = 1.0, squares = kWithinOne;
  for (const double sign : {-1.0, 1.0}) {
    const double room = sign < 0.0 ? value : readings - value;
    double before = 0.0, last = 1.0;
    for (double off = 1.0; off <= room && last > std::exp(-kGone); off *= 2.0) {
      const Hypothesis moved = Moved(at, {size}, Eigen::VectorXd::Constant(1, sign * off / size.u));
      const double likelihood = std::exp(std::min(0.0, LogLikelihood(chi2_of(moved), rows) - best));
      const double between = 0.5 * (off - before - 1.0);  // readings on either half of the trapezoid
      sum += between * last + (between + 1.0) * likelihood;
      squares += between * last * before * before + (between + 1.0) * likelihood * off * off;
      before = off;
      last = likelihood;
    }
  }
  return {std::log(sum / std::max(1.0, readings)), std::sqrt(squares / sum) / size.u};
}

/// Of the run in which the cause happened.
double ReadingsIn(const Supposed& cause, std::span<const TakenRun> runs) {
  const auto run = std::ranges::find(runs, cause.happened_in, &TakenRun::number);
  return run == runs.end() ? 1.0 : static_cast<double>(run->readings.size());
}

/// @param cov  In units of the u that the sizes came with.
void StateUncertainties(const Eigen::MatrixXd& cov, const std::vector<Size>& sizes, JointFit& fit) {
  const Eigen::VectorXd u = cov.diagonal().cwiseSqrt();
  fit.cov = u.cwiseInverse().asDiagonal() * cov * u.cwiseInverse().asDiagonal();
  for (std::size_t k = 0; k < sizes.size(); ++k)
    fit.hypothesis.causes[sizes[k].cause].finding.u[sizes[k].name] = u[static_cast<Eigen::Index>(k)] * sizes[k].u;
}

}  // namespace

void StateCertainty(const std::vector<Size>& sizes, Normal normal, std::span<const TakenRun> runs,
                    const Means& means, JointFit& fit) {
  const Eigen::VectorXd breadth = Breadth(fit.hypothesis, sizes);
  const std::vector<Eigen::Index> near = NearBounds(fit.hypothesis, sizes, CovarianceOf(normal.matrix, breadth));
  const Eigen::VectorXd curvature = normal.matrix.diagonal();
  Strike(near, normal);
  Eigen::MatrixXd cov = CovarianceOf(normal.matrix, breadth);
  fit.log_evidence = LogLikelihood(fit.chi2, Rows(runs)) + LogShareLeft(normal.matrix, breadth);
  const auto chi2_of = [&](const Hypothesis& moved) {
    return FollowedBy(LeftOf(moved, runs, means), normal, breadth, runs);
  };
  const auto take_in = [&](Eigen::Index k, const Summed& summed) {
    fit.log_evidence += summed.log_share;
    if (summed.u > 0.0) cov(k, k) = summed.u * summed.u;
  };
  for (const Eigen::Index k : near) {
    const Size& size = sizes[static_cast<std::size_t>(k)];
    const double wide = curvature[k] > 0.0 ? 1.0 / std::sqrt(curvature[k]) : 0.0;
    take_in(k, SummedFrom(fit.hypothesis, size, breadth[k], wide, fit.chi2, chi2_of, Rows(runs)));
  }
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    if (sizes[k].name != kHappenedAt) continue;
    const double readings = ReadingsIn(fit.hypothesis.causes[sizes[k].cause], runs);
    take_in(static_cast<Eigen::Index>(k),
            SummedOverReadings(fit.hypothesis, sizes[k], fit.chi2, chi2_of, Rows(runs), readings));
  }
  StateUncertainties(cov, sizes, fit);
}

}  // namespace twinbench::investigate
