#include "twin/investigate/free_sizes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/happened_once.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/signal_effect.h"
#include "twin/core/units.h"

namespace twinbench::investigate {
namespace {

/// A frequency is sought everywhere between its bounds: a normal distribution that is nowhere denser than an even
/// one there.
double ThoughtWithin(const EffectParameter& parameter, const EffectEntry& entry, double lower, double upper) {
  if (parameter.name == "frequency") return (upper - lower) / std::sqrt(2.0 * units::kPi);
  return ThoughtOf(parameter, entry);
}

}  // namespace

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

Hypothesis Moved(Hypothesis hypothesis, const std::vector<Size>& sizes, const Eigen::VectorXd& by) {
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    double& value = hypothesis.causes[sizes[k].cause].parameters.at(sizes[k].name);
    value = std::clamp(value + by[static_cast<Eigen::Index>(k)] * sizes[k].u, sizes[k].lower, sizes[k].upper);
  }
  return hypothesis;
}

double BoundOf(const Hypothesis& hypothesis, const Size& size) {
  const double value = ValueOf(hypothesis, size);
  return size.upper - value < value - size.lower ? size.upper : size.lower;
}

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

Eigen::MatrixXd SlopesOf(const Hypothesis& hypothesis, const Eigen::VectorXd& left, const TakenRun& run,
                         const Means& means) {
  const std::vector<Size> sizes = SizesOf(hypothesis, run.scenario.bench);
  Eigen::MatrixXd slopes(left.size(), std::ssize(sizes));
  for (Eigen::Index k = 0; k < slopes.cols(); ++k)
    slopes.col(k) = SlopeOf(hypothesis, sizes[static_cast<std::size_t>(k)], left, run, means);
  return slopes;
}

Left LeftOf(const Hypothesis& hypothesis, std::span<const TakenRun> runs, const Means& means) {
  Left left;
  for (const TakenRun& run : runs) {
    left.of.push_back(LeftBy(hypothesis, run, means));
    left.chi2 += Product(run, left.of.back(), left.of.back())(0, 0);
  }
  return left;
}

Normal NormalOf(const Hypothesis& hypothesis, const Left& left, std::span<const TakenRun> runs, const Means& means,
                Eigen::Index sizes) {
  Normal normal{Eigen::MatrixXd::Zero(sizes, sizes), Eigen::VectorXd::Zero(sizes), {}};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    normal.slopes.push_back(SlopesOf(hypothesis, left.of[k], runs[k], means));
    normal.matrix += Product(runs[k], normal.slopes[k], normal.slopes[k]);
    normal.gradient += Product(runs[k], normal.slopes[k], left.of[k]);
  }
  return normal;
}

Eigen::VectorXd Breadth(const Hypothesis& hypothesis, const std::vector<Size>& sizes) {
  Eigen::VectorXd breadth(std::ssize(sizes));
  for (std::size_t k = 0; k < sizes.size(); ++k)
    breadth[static_cast<Eigen::Index>(k)] =
        std::max(sizes[k].plausible, std::abs(ValueOf(hypothesis, sizes[k]))) / sizes[k].u;
  return breadth;
}

Eigen::MatrixXd CovarianceOf(const Eigen::MatrixXd& normal, const Eigen::VectorXd& breadth) {
  const Eigen::MatrixXd before = breadth.array().square().inverse().matrix().asDiagonal();
  return SolvePositive(normal + before, Eigen::MatrixXd(Eigen::MatrixXd::Identity(normal.rows(), normal.cols())));
}

}  // namespace twinbench::investigate
