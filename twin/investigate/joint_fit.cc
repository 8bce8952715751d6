#include "twin/investigate/joint_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "twin/core/happened_once.h"
#include "twin/core/signal_effect.h"
#include "twin/core/units.h"
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

/// A frequency is sought everywhere between its bounds: a normal distribution that is nowhere denser than an even one there.
double ThoughtWithin(const EffectParameter& parameter, const EffectEntry& entry, double lower, double upper) {
  if (parameter.name == "frequency") return (upper - lower) / std::sqrt(2.0 * units::kPi);
  return ThoughtOf(parameter, entry);
}

std::vector<Size> SizesOf(const Hypothesis& hypothesis, const std::string& bench) {
  std::vector<Size> sizes;
  for (std::size_t k = 0; k < hypothesis.causes.size(); ++k) {
    const EffectEntry entry = EntryOf(hypothesis.causes[k], bench);
    for (const EffectParameter& p : entry.parameters) {
      const auto u = hypothesis.causes[k].finding.u.find(p.name);
      if (u == hypothesis.causes[k].finding.u.end() || !(u->second > 0.0)) continue;
      const auto within = hypothesis.causes[k].within.find(p.name);
      const bool is_bounded = within != hypothesis.causes[k].within.end();
      const auto [lower, upper] = is_bounded ? within->second : std::pair(p.lower_SI, p.upper_SI);
      const double thought = is_bounded ? ThoughtWithin(p, entry, lower, upper) : ThoughtOf(p, entry);
      sizes.push_back({k, p.name, u->second, std::max(lower, p.lower_SI), std::min(upper, p.upper_SI), thought});
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

/// Change of what is left of one run for one u of a size. What happens at one reading jumps there: it has none.
Eigen::VectorXd SlopeOf(const Hypothesis& hypothesis, const Size& size, const Eigen::VectorXd& left,
                        const TakenRun& run, const Means& means) {
  if (size.name == kHappenedAt) return Eigen::VectorXd::Zero(left.size());
  constexpr double kStep = 0.25;  // of u; away from the nearer bound
  const double value = ValueOf(hypothesis, size);
  const double step = size.upper - value > value - size.lower ? kStep : -kStep;
  const Hypothesis moved = Moved(hypothesis, {size}, Eigen::VectorXd::Constant(1, step));
  const double went = (ValueOf(moved, size) - value) / size.u;
  return (LeftBy(moved, run, means) - left) / (went == 0.0 ? step : went);
}

/// What the hypothesis leaves of every run.
struct Left {
  std::vector<Eigen::VectorXd> of;
  double chi2 = 0.0;
};

Left LeftOf(const Hypothesis& hypothesis, std::span<const TakenRun> runs, const Means& means) {
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
  std::vector<Eigen::MatrixXd> slopes;  // of each run
};

Normal NormalOf(const Hypothesis& hypothesis, const Left& left, std::span<const TakenRun> runs,
                const Means& means, Eigen::Index sizes) {
  Normal normal{Eigen::MatrixXd::Zero(sizes, sizes), Eigen::VectorXd::Zero(sizes), {}};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    normal.slopes.push_back(SlopesOf(hypothesis, left.of[k], runs[k], means));
    normal.matrix += Product(runs[k], normal.slopes[k], normal.slopes[k]);
    normal.gradient += Product(runs[k], normal.slopes[k], left.of[k]);
  }
  return normal;
}

double Rows(std::span<const TakenRun> runs) {
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
  return -widened.llt().matrixLLT().diagonal().array().log().sum();
}

/// Directions that no run shows keep the uncertainty that was thought of before.
Eigen::MatrixXd CovarianceOf(const Eigen::MatrixXd& normal, const Eigen::VectorXd& breadth) {
  const Eigen::MatrixXd before = breadth.array().square().inverse().matrix().asDiagonal();
  return (normal + before).llt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
}

/// The nearer one [SI].
double BoundOf(const Hypothesis& hypothesis, const Size& size) {
  const double value = ValueOf(hypothesis, size);
  return size.upper - value < value - size.lower ? size.upper : size.lower;
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

/// Slopes say little of a size near a bound: a gap that is crossed at once looks the same up to the distance of two
/// readings, and like nothing beyond. So its likelihood is summed over distances, the other sizes following it by
/// their slopes, against half a normal distribution of its breadth.
Summed SummedFrom(const Hypothesis& at, const Size& size, double breadth, double chi2,
                     const std::function<double(const Hypothesis&)>& chi2_of, double rows) {
  constexpr int kHalvings = 7;
  constexpr double kFarthest = 3.0, kGone = 12.0;  // of breadth; of log likelihood
  const double bound = BoundOf(at, size), room = (size.upper - size.lower) / size.u;
  const double from = (bound - ValueOf(at, size)) / size.u, sign = bound == size.lower ? 1.0 : -1.0;
  const double best = LogLikelihood(chi2, rows);
  const auto likelihood_at = [&](double distance) {
    const Hypothesis moved = Moved(at, {size}, Eigen::VectorXd::Constant(1, from + sign * distance));
    return std::exp(std::min(0.0, LogLikelihood(chi2_of(moved), rows) - best));
  };
  const auto squared_off = [&](double distance) { return std::pow(from + sign * distance, 2); };
  const double farthest = std::min(room, kFarthest * breadth);
  double before = 0.0, mass = 0.0, thought = 0.0, squares = 0.0, last = likelihood_at(0.0);
  for (int halving = kHalvings; halving >= 0; --halving) {
    const double distance = std::ldexp(farthest, -halving);
    const double likelihood = distance > std::abs(from) && last < std::exp(-kGone) ? 0.0 : likelihood_at(distance);
    const double prior_before = std::exp(-0.5 * std::pow(before / breadth, 2)),
                 prior = std::exp(-0.5 * std::pow(distance / breadth, 2)), step = 0.5 * (distance - before);
    thought += step * (prior_before + prior);
    mass += step * (prior_before * last + prior * likelihood);
    squares += step * (squared_off(before) * prior_before * last + squared_off(distance) * prior * likelihood);
    before = distance;
    last = likelihood;
  }
  mass = std::max(mass, thought * std::exp(-kGone));
  return {std::log(mass / thought), std::sqrt(squares / mass)};
}

/// What happens at one reading may have done so at any of its run, each as likely as the others beforehand: the
/// likelihood is summed over them, by trapezoids of doubling width, the other sizes following by their slopes.
Summed SummedOverReadings(const Hypothesis& at, const Size& size, double chi2,
                          const std::function<double(const Hypothesis&)>& chi2_of, double rows, double readings) {
  constexpr double kGone = 12.0;  // of log likelihood
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

/// The whole step, or as much less as the twin bends.
std::pair<Hypothesis, Left> BestAlong(const Hypothesis& from, const std::vector<Size>& sizes,
                                      const Eigen::VectorXd& by, std::span<const TakenRun> runs,
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
                                         const Normal& normal, std::span<const TakenRun> runs,
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

/// The best place between a size and a bound, each halfway on from the one before; where something begins at once - a
/// clipping that readings are near or not - neither end nor slopes say where.
struct Between {
  std::pair<Hypothesis, Left> best;
  double off = 0.0;  // of the bound [SI]
};

Between BestBetween(const Hypothesis& from, const Size& size, double end, std::pair<Hypothesis, Left> at_end,
                    std::span<const TakenRun> runs, const Means& means) {
  constexpr int kHalvings = 10;
  const double off = ValueOf(from, size) - end;
  Between between{std::move(at_end)};
  for (int halving = 1; halving <= kHalvings; ++halving) {
    const double to = std::ldexp(off, -halving);
    Hypothesis moved = Moved(from, {size}, Eigen::VectorXd::Constant(1, (to - off) / size.u));
    Left now = LeftOf(moved, runs, means);
    if (!(now.chi2 < between.best.second.chi2)) continue;
    between = {{std::move(moved), std::move(now)}, std::abs(to)};
  }
  return between;
}

/// No reading has narrowed it yet: where it stands says nothing of where it belongs.
bool IsUnread(const Size& size) {
  return size.u >= size.plausible;
}

/// A bound that is not far may be where a size belongs: a state one way or the other, a gap that is crossed at
/// once. Slopes do not lead there. When something happened has no such place: before the first reading it is not seen.
void TryEnds(const std::vector<Size>& sizes, std::span<const TakenRun> runs, const Means& means,
             Hypothesis& hypothesis, Left& left) {
  constexpr double kNotFar = 6.0;  // u
  for (const Size& size : sizes) {
    if (size.name == kHappenedAt) continue;
    for (const double end : {size.lower, size.upper}) {
      const double steps = (end - ValueOf(hypothesis, size)) / size.u;
      const bool is_nothing = end == size.lower && end >= 0.0;  // no gap, no time: worth a look from anywhere
      if (steps == 0.0 || (std::abs(steps) > kNotFar && !is_nothing)) continue;
      Hypothesis moved = Moved(hypothesis, {size}, Eigen::VectorXd::Constant(1, steps));
      Left now = LeftOf(moved, runs, means);
      if (!(now.chi2 < left.chi2)) continue;
      Between between{{std::move(moved), std::move(now)}};
      if (IsUnread(size)) between = BestBetween(hypothesis, size, end, std::move(between.best), runs, means);
      std::tie(hypothesis, left) = std::move(between.best);
      // Slopes of what begins there are those of steps that are small beside its size.
      double& u = hypothesis.causes[size.cause].finding.u.at(size.name);
      if (between.off > 0.0) u = std::min(u, 0.5 * between.off);
    }
  }
}

/// One size by its slope, the others as they are.
std::pair<Hypothesis, Left> BestOf(const Size& size, const Hypothesis& from, std::span<const TakenRun> runs,
                                   const Means& means) {
  Left at = LeftOf(from, runs, means);
  double curvature = 0.0, gradient = 0.0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const Eigen::VectorXd slope = SlopeOf(from, size, at.of[k], runs[k], means);
    curvature += Product(runs[k], slope, slope)(0, 0);
    gradient += Product(runs[k], slope, at.of[k])(0, 0);
  }
  if (!(curvature > 0.0)) return {from, std::move(at)};
  auto best = BestAlong(from, {size}, Eigen::VectorXd::Constant(1, -gradient / curvature), runs, means);
  return best.second.chi2 < at.chi2 ? std::move(best) : std::pair{from, std::move(at)};
}

/// A wave whose phase may be any: where it begins or a quarter of a turn on, as large as it fits best. From one of
/// them slopes lead there.
void TryQuarterTurns(const std::vector<Size>& sizes, std::span<const TakenRun> runs, const Means& means,
                     Hypothesis& hypothesis, Left& left) {
  constexpr double kAnywhere_rad = 0.5;
  const Hypothesis from = hypothesis;
  for (const Size& phase : sizes) {
    if (phase.name != kPhase || phase.u < kAnywhere_rad) continue;
    for (const Size& size : sizes) {
      if (size.cause != phase.cause || size.name == kPhase) continue;
      for (const double turned_rad : {0.0, 0.5 * units::kPi}) {
        const Hypothesis turned = Moved(from, {phase}, Eigen::VectorXd::Constant(1, turned_rad / phase.u));
        auto [moved, now] = BestOf(size, turned, runs, means);
        if (!(now.chi2 < left.chi2)) continue;
        hypothesis = std::move(moved);
        left = std::move(now);
      }
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

/// Evidence and uncertainties of a fit that has ended.
void StateCertainty(const std::vector<Size>& sizes, Normal normal, std::span<const TakenRun> runs,
                    const Means& means, JointFit& fit) {
  const Eigen::VectorXd breadth = Breadth(fit.hypothesis, sizes);
  const std::vector<Eigen::Index> near = NearBounds(fit.hypothesis, sizes, CovarianceOf(normal.matrix, breadth));
  Strike(near, normal);
  Eigen::MatrixXd cov = CovarianceOf(normal.matrix, breadth);
  fit.log_evidence = LogLikelihood(fit.chi2, Rows(runs)) + LogShareLeft(normal.matrix, breadth);
  const auto chi2_of = [&](const Hypothesis& moved) {
    return FollowedBy(LeftOf(moved, runs, means), normal, breadth, runs);
  };
  const auto take_in = [&](Eigen::Index k, const Summed& summed) {
    fit.log_evidence += summed.log_share;
    cov(k, k) = summed.u * summed.u;
  };
  for (const Eigen::Index k : near) {
    const Size& size = sizes[static_cast<std::size_t>(k)];
    take_in(k, SummedFrom(fit.hypothesis, size, breadth[k], fit.chi2, chi2_of, Rows(runs)));
  }
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    if (sizes[k].name != kHappenedAt) continue;
    const double readings = ReadingsIn(fit.hypothesis.causes[sizes[k].cause], runs);
    take_in(static_cast<Eigen::Index>(k),
            SummedOverReadings(fit.hypothesis, sizes[k], fit.chi2, chi2_of, Rows(runs), readings));
  }
  StateUncertainties(cov, sizes, fit);
}

}  // namespace

Eigen::MatrixXd SlopesOf(const Hypothesis& hypothesis, const Eigen::VectorXd& left, const TakenRun& run,
                         const Means& means) {
  const std::vector<Size> sizes = SizesOf(hypothesis, run.scenario.bench);
  Eigen::MatrixXd slopes(left.size(), std::ssize(sizes));
  for (Eigen::Index k = 0; k < slopes.cols(); ++k)
    slopes.col(k) = SlopeOf(hypothesis, sizes[static_cast<std::size_t>(k)], left, run, means);
  return slopes;
}

double Chi2Of(const Hypothesis& hypothesis, std::span<const TakenRun> runs, const Means& means) {
  return LeftOf(hypothesis, runs, means).chi2;
}

JointFit FitJointly(const Hypothesis& hypothesis, std::span<const TakenRun> runs, const Means& means) {
  constexpr int kMostRounds = 6;
  constexpr double kStill = 0.05;  // of chi2: less is no better
  const std::string& bench = runs.front().scenario.bench;
  JointFit fit;
  fit.hypothesis = hypothesis;
  Left left = LeftOf(hypothesis, runs, means);
  TryEnds(SizesOf(hypothesis, bench), runs, means, fit.hypothesis, left);
  const std::vector<Size> sizes = SizesOf(fit.hypothesis, bench);
  TryQuarterTurns(sizes, runs, means, fit.hypothesis, left);
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
  fit.chi2 = left.chi2;
  StateCertainty(sizes, std::move(normal), runs, means, fit);
  return fit;
}

}  // namespace twinbench::investigate
