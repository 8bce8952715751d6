#include "twin/investigate/joint_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "twin/core/happened_once.h"
#include "twin/core/signal_effect.h"
#include "twin/core/units.h"
#include "twin/investigate/fit_certainty.h"
#include "twin/investigate/free_sizes.h"

namespace twinbench::investigate {
namespace {

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

}  // namespace

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
