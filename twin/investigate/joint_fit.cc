#include "twin/investigate/joint_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "twin/core/signal_effect.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::investigate {
namespace {

/// A size that is free: of which cause, and which of its parameters.
struct Size {
  std::size_t cause;
  std::string name;
  double u;             // SI: the unit that it is counted in
  double lower, upper;  // SI
  double plausible;     // SI
};

std::vector<Size> SizesOf(const Hypothesis& hypothesis, const std::string& bench) {
  std::vector<Size> sizes;
  for (std::size_t k = 0; k < hypothesis.causes.size(); ++k) {
    const EffectEntry entry = EntryOf(hypothesis.causes[k], bench);
    for (const EffectParameter& p : entry.parameters) {
      const auto u = hypothesis.causes[k].finding.u.find(p.name);
      if (u == hypothesis.causes[k].finding.u.end() || !(u->second > 0.0)) continue;
      sizes.push_back({k, p.name, u->second, p.lower_SI, p.upper_SI, entry.Plausible(p)});
    }
  }
  return sizes;
}

double ValueOf(const Hypothesis& hypothesis, const Size& size) {
  return hypothesis.causes[size.cause].parameters.at(size.name);
}

/// @param by  In units of u. What leaves its bounds stays on them.
Hypothesis Moved(Hypothesis hypothesis, const std::vector<Size>& sizes, const Eigen::VectorXd& by) {
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    double& value = hypothesis.causes[sizes[k].cause].parameters.at(sizes[k].name);
    value = std::clamp(value + by[static_cast<Eigen::Index>(k)] * sizes[k].u, sizes[k].lower, sizes[k].upper);
  }
  return hypothesis;
}

/// What the hypothesis leaves of every run.
struct Left {
  std::vector<Eigen::VectorXd> of;
  double chi2 = 0.0;
};

Left LeftOf(const Hypothesis& hypothesis, const std::vector<TakenRun>& runs, const Means& means) {
  Left left;
  for (const TakenRun& run : runs) {
    left.of.push_back(LeftBy(hypothesis, run, means));
    left.chi2 += Product(run, left.of.back(), left.of.back())(0, 0);
  }
  return left;
}

/// Normal equations of the sizes, over all runs.
struct Normal {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
};

Normal NormalOf(const Hypothesis& hypothesis, const Left& left, const std::vector<TakenRun>& runs,
                const Means& means, Eigen::Index sizes) {
  Normal normal{Eigen::MatrixXd::Zero(sizes, sizes), Eigen::VectorXd::Zero(sizes)};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const Eigen::MatrixXd slopes = SlopesOf(hypothesis, left.of[k], runs[k], means);
    normal.matrix += Product(runs[k], slopes, slopes);
    normal.gradient += Product(runs[k], slopes, left.of[k]);
  }
  return normal;
}

double Rows(const std::vector<TakenRun>& runs) {
  double rows = 0.0;
  for (const TakenRun& run : runs) rows += run.projector->DegreesOfFreedom();
  return rows;
}

/// Of what was thought of the sizes before, in units of u.
Eigen::VectorXd Breadth(const Hypothesis& hypothesis, const std::vector<Size>& sizes) {
  Eigen::VectorXd breadth(std::ssize(sizes));
  for (std::size_t k = 0; k < sizes.size(); ++k)
    breadth[static_cast<Eigen::Index>(k)] =
        std::max(sizes[k].plausible, std::abs(ValueOf(hypothesis, sizes[k]))) / sizes[k].u;
  return breadth;
}

double LogEvidence(double chi2, double rows, const Eigen::MatrixXd& normal, const Eigen::VectorXd& breadth) {
  const double trust = diagnose::tuning::kPseudoDegrees;
  const double fit = -0.5 * (trust + rows) * std::log(trust + chi2);
  if (breadth.size() == 0) return fit;
  const Eigen::MatrixXd widened = Eigen::MatrixXd::Identity(normal.rows(), normal.cols()) +
                                  breadth.asDiagonal() * normal * breadth.asDiagonal();
  return fit - widened.llt().matrixLLT().diagonal().array().log().sum();
}

/// Directions that no run shows keep the uncertainty that was thought of before.
Eigen::MatrixXd CovarianceOf(const Eigen::MatrixXd& normal, const Eigen::VectorXd& breadth) {
  const Eigen::MatrixXd before = breadth.array().square().inverse().matrix().asDiagonal();
  return (normal + before).llt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
}

/// The whole step, or as much less as the twin bends.
std::pair<Hypothesis, Left> BestAlong(const Hypothesis& from, const std::vector<Size>& sizes,
                                      const Eigen::VectorXd& by, const std::vector<TakenRun>& runs,
                                      const Means& means) {
  std::pair<Hypothesis, Left> best;
  best.second.chi2 = std::numeric_limits<double>::infinity();
  for (const double share : {1.0, 0.5, 0.25}) {
    Hypothesis moved = Moved(from, sizes, share * by);
    Left left = LeftOf(moved, runs, means);
    if (!(left.chi2 < best.second.chi2)) break;
    best = {std::move(moved), std::move(left)};
    constexpr double kShort = 2.0;  // of u: nothing bends so soon
    if (by.cwiseAbs().maxCoeff() < kShort) break;
  }
  return best;
}

/// Gauss and Newton's, of those that are not on a bound that it would push them over.
Eigen::VectorXd StepOf(const Normal& normal, const Hypothesis& hypothesis, const std::vector<Size>& sizes) {
  Eigen::MatrixXd matrix = normal.matrix;
  Eigen::VectorXd gradient = normal.gradient;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const double value = ValueOf(hypothesis, sizes[k]);
    const bool is_stopped = gradient[row] > 0.0 ? value <= sizes[k].lower : value >= sizes[k].upper;
    if (!is_stopped) continue;
    matrix.row(row).setZero();
    matrix.col(row).setZero();
    gradient[row] = 0.0;
  }
  return -CovarianceOf(matrix, Breadth(hypothesis, sizes)) * gradient;
}

/// Each size by itself after the other, where the twin bends too much for all together.
std::pair<Hypothesis, Left> BestOneByOne(const Hypothesis& from, const Left& at, const std::vector<Size>& sizes,
                                         const Normal& normal, const std::vector<TakenRun>& runs,
                                         const Means& means) {
  std::pair<Hypothesis, Left> best = {from, at};
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    if (!(normal.matrix(row, row) > 0.0)) continue;
    const Eigen::VectorXd step = Eigen::VectorXd::Constant(1, -normal.gradient[row] / normal.matrix(row, row));
    auto moved = BestAlong(best.first, {sizes[k]}, step, runs, means);
    if (moved.second.chi2 < best.second.chi2) best = std::move(moved);
  }
  return best;
}

/// A bound that is not far may be where a size belongs: a state one way or the other, a gap that is crossed at
/// once. Slopes do not lead there.
void TryEnds(const std::vector<Size>& sizes, const std::vector<TakenRun>& runs, const Means& means,
             Hypothesis& hypothesis, Left& left) {
  constexpr double kNotFar = 6.0;  // u
  for (const Size& size : sizes) {
    for (const double end : {size.lower, size.upper}) {
      const double steps = (end - ValueOf(hypothesis, size)) / size.u;
      const bool is_nothing = end == size.lower && end >= 0.0;  // no gap, no time: worth a look from anywhere
      if (steps == 0.0 || (std::abs(steps) > kNotFar && !is_nothing)) continue;
      Hypothesis moved = Moved(hypothesis, {size}, Eigen::VectorXd::Constant(1, steps));
      Left now = LeftOf(moved, runs, means);
      if (!(now.chi2 < left.chi2)) continue;
      hypothesis = std::move(moved);
      left = std::move(now);
    }
  }
}

/// @param cov  In units of the u that the sizes came with.
void StateUncertainties(const Eigen::MatrixXd& cov, const std::vector<Size>& sizes, JointFit& fit) {
  const Eigen::VectorXd u = cov.diagonal().cwiseSqrt();
  fit.cov = u.cwiseInverse().asDiagonal() * cov * u.cwiseInverse().asDiagonal();
  for (std::size_t k = 0; k < sizes.size(); ++k)
    fit.hypothesis.causes[sizes[k].cause].finding.u[sizes[k].name] = u[static_cast<Eigen::Index>(k)] * sizes[k].u;
}

}  // namespace

Eigen::MatrixXd SlopesOf(const Hypothesis& hypothesis, const Eigen::VectorXd& left, const TakenRun& run,
                         const Means& means) {
  const std::vector<Size> sizes = SizesOf(hypothesis, run.scenario.bench);
  Eigen::MatrixXd slopes(left.size(), std::ssize(sizes));
  for (Eigen::Index k = 0; k < slopes.cols(); ++k) {
    const Size& size = sizes[static_cast<std::size_t>(k)];
    constexpr double kStep = 0.25;  // of u; away from the nearer bound
    const double value = ValueOf(hypothesis, size);
    const double step = size.upper - value > value - size.lower ? kStep : -kStep;
    const Hypothesis moved = Moved(hypothesis, {size}, Eigen::VectorXd::Constant(1, step));
    const double went = (ValueOf(moved, size) - value) / size.u;
    slopes.col(k) = (LeftBy(moved, run, means) - left) / (went == 0.0 ? step : went);
  }
  return slopes;
}

JointFit FitJointly(const Hypothesis& hypothesis, const std::vector<TakenRun>& runs, const Means& means) {
  constexpr int kMostRounds = 6;
  constexpr double kStill = 0.05;  // of chi2: less is no better
  const std::vector<Size> sizes = SizesOf(hypothesis, runs.front().scenario.bench);
  JointFit fit;
  fit.hypothesis = hypothesis;
  Left left = LeftOf(hypothesis, runs, means);
  TryEnds(sizes, runs, means, fit.hypothesis, left);
  Normal normal = NormalOf(fit.hypothesis, left, runs, means, std::ssize(sizes));
  for (int round = 0; round < kMostRounds && !sizes.empty(); ++round) {
    auto [moved, now] = BestAlong(fit.hypothesis, sizes, StepOf(normal, fit.hypothesis, sizes), runs, means);
    if (!(now.chi2 < left.chi2))
      std::tie(moved, now) = BestOneByOne(fit.hypothesis, left, sizes, normal, runs, means);
    if (!(now.chi2 < left.chi2)) break;
    const double gained = left.chi2 - now.chi2;
    fit.hypothesis = std::move(moved);
    left = std::move(now);
    if (gained < kStill) break;
    normal = NormalOf(fit.hypothesis, left, runs, means, std::ssize(sizes));
  }
  const Eigen::VectorXd breadth = Breadth(fit.hypothesis, sizes);
  fit.chi2 = left.chi2;
  fit.log_evidence = LogEvidence(fit.chi2, Rows(runs), normal.matrix, breadth);
  StateUncertainties(CovarianceOf(normal.matrix, breadth), sizes, fit);
  return fit;
}

}  // namespace twinbench::investigate
