#include "twin/diagnose/screen/scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/KroneckerProduct>

#include "twin/core/linear_algebra.h"
#include "twin/diagnose/screen/circumstances.h"

namespace twinbench::diagnose::screen {
namespace {

/// M with M M' the inverse of the information in the directions that survive the projection.
Eigen::MatrixXd SurvivingRoot(const Fit& fit) {
  constexpr double kSurvives = 1e-3;
  const Eigen::VectorXd scale = (fit.before.array() > 0.0).select(fit.before.array().rsqrt(), 0.0);
  const auto [values, vectors] = EigenOfSymmetric(scale.asDiagonal() * fit.information * scale.asDiagonal());
  const auto dof = (values.array() > kSurvives).count();
  return scale.asDiagonal() * vectors.rightCols(dof) * values.tail(dof).cwiseSqrt().cwiseInverse().asDiagonal();
}

void Solve(Fit& fit) {
  const Eigen::MatrixXd root = SurvivingRoot(fit), score = root.transpose() * fit.gradient;
  fit.dof = static_cast<int>(root.cols());
  fit.chi2 = score.colwise().squaredNorm();
  fit.amplitude = root * score.col(0);
}

/// Shapes of the items [first, first + count) on one channel, side by side.
Eigen::MatrixXd ShapesOf(const Scan& scan, int first, int count, int channel) {
  Eigen::MatrixXd shapes(scan.items.front().shape.front().rows(), count * scan.width);
  for (int e = 0; e < count; ++e) {
    const std::vector<Eigen::MatrixXd>& shape = scan.items[first + e].shape;
    shapes.middleCols(e * scan.width, scan.width) = shape[shape.size() == 1 ? 0 : channel];
  }
  return shapes;
}

/// Fits of the items [first, first + count) to all columns, still to be solved. Whitening keeps channels apart,
/// projection mixes them.
std::vector<Fit> NormalEquations(const Sample& s, const Scan& scan, int first, int count) {
  const int channels = s.run.Channels(), width = scan.width, size = channels * width;
  const Fit empty{width, Eigen::MatrixXd::Zero(size, size), {}, Eigen::MatrixXd(size, s.Columns()), {}, 0, {}};
  std::vector<Fit> fits(count, empty);
  Eigen::MatrixXd white = Eigen::MatrixXd::Zero(s.run.Rows(), count * size);
  for (int c = 0; c < channels; ++c) {
    const Eigen::MatrixXd shapes = ShapesOf(scan, first, count, c);
    const Eigen::MatrixXd whitened = s.whitening[c] * shapes, gradient = shapes.transpose() * s.adjoint[c];
    for (int e = 0; e < count; ++e) {
      const auto item = whitened.middleCols(e * width, width);
      white(RowsOf(s.run, c), Eigen::seqN((e * channels + c) * width, width)) = item;
      fits[e].information.block(c * width, c * width, width, width) = item.transpose() * item;
      fits[e].gradient.middleRows(c * width, width) = gradient.middleRows(e * width, width);
    }
  }
  const Eigen::MatrixXd absorbed = s.projector.Absorbed(white);
  for (int e = 0; e < count; ++e) {
    const auto h = absorbed.middleCols(e * size, size);
    fits[e].before = fits[e].information.diagonal();
    fits[e].information.noalias() -= h.transpose() * h;
  }
  return fits;
}

void SetLargestAmplitude(const LinearRun& run, const Fit& fit, ScreenTest& test) {
  int largest = 0;
  const Eigen::RowVectorXd size = fit.amplitude.reshaped(fit.width, run.Channels()).colwise().norm();
  const double size_SI = size.maxCoeff(&largest);
  SetEffect(run, largest, size_SI, test);
}

/// What a place must explain to be named: 3/4 of what exceeds the expectation of noise, and half of all.
double LeastToName(const Fit& fit) {
  return std::max(fit.width + 0.75 * (fit.chi2[0] - fit.dof), 0.5 * fit.chi2[0]);
}

/// Each channel takes the pattern's weight times one common set of amplitudes.
Fit CommonFit(const Fit& fit, const Pattern& pattern) {
  const Eigen::MatrixXd each = Eigen::MatrixXd::Identity(fit.width, fit.width);
  return fit.Constrained(Eigen::kroneckerProduct(pattern.weight, each), fit.width);
}

}  // namespace

double NormalScore(double chi2, int dof) {
  const double variance = 2.0 / (9.0 * dof);
  return (std::cbrt(chi2 / dof) - 1.0 + variance) / std::sqrt(variance);
}

Fit Fit::Constrained(const Eigen::MatrixXd& constraint, int new_width) const {
  Fit fit;
  fit.width = new_width;
  fit.information = constraint.transpose() * information * constraint;
  fit.before = (constraint.transpose() * before.asDiagonal() * constraint).diagonal();
  fit.gradient = constraint.transpose() * gradient;
  Solve(fit);
  return fit;
}

Fit FitItem(const Sample& sample, const Scan& scan, int item) {
  Fit fit = NormalEquations(sample, scan, item, 1).front();
  fit.gradient = fit.gradient.col(0).eval();
  for (int c = 0; c < sample.run.Channels(); ++c)
    fit.gradient.middleRows(c * scan.width, scan.width) *= sample.level[c];  // the run as it was before levelling
  Solve(fit);
  return fit;
}

Eigen::MatrixXd Scores(const Sample& sample, const Scan& scan) {
  const auto items = static_cast<int>(scan.items.size());
  const int chunk = std::max(1, 64 / (sample.run.Channels() * scan.width));
  Eigen::MatrixXd scores(items, sample.Columns());
  int item = 0;
  for (int first = 0; first < items; first += chunk) {
    for (Fit& fit : NormalEquations(sample, scan, first, std::min(chunk, items - first))) {
      Solve(fit);
      const auto score = [&](double chi2) {
        return fit.dof > 0 ? NormalScore(chi2, fit.dof) : -std::numeric_limits<double>::infinity();
      };
      scores.row(item++) = fit.chi2.unaryExpr(score);
    }
  }
  return scores;
}

void Describe(const Sample& sample, const Fit& fit, bool one_shape, const std::string& item, ScreenTest& test) {
  const LinearRun& run = sample.run;
  std::string place = run.Channels() == 1 ? "on " + run.channels.front() : "on several channels";
  SetLargestAmplitude(run, fit, test);
  double best = LeastToName(fit);
  const auto offer = [&](const Pattern& pattern, const std::string& words) {
    const Fit common = CommonFit(fit, pattern);
    if (run.Channels() == 1 || !(common.chi2[0] > best)) return;
    best = common.chi2[0];
    place = words;
    SetEffect(run, pattern, common.amplitude.norm(), test);
  };
  if (one_shape) {
    for (const Pattern& p : run.patterns) offer(p, "in " + p.name);
  }
  for (int c = 0; c < run.Channels(); ++c)
    offer({run.channels[c], Eigen::VectorXd::Unit(run.Channels(), c)}, "on " + run.channels[c]);
  test.reading = fmt::format("residual follows {} {}: {}", item, place, ReadingOf(test.name));
}

std::optional<Scanned> Strongest(const Sample& sample, const Scan& scan) {
  Statistic statistic{scan.test, {}, Scores(sample, scan)};
  if (scan.items.empty() || !std::isfinite(statistic.values.col(0).maxCoeff())) return std::nullopt;
  for (const Scan::Item& item : scan.items) statistic.items.push_back(item.words);
  auto [test, item] = LoudestOf(statistic);
  Scanned strongest{std::move(test), item, FitItem(sample, scan, item)};
  const bool one_shape = scan.items.front().shape.size() == 1;
  Describe(sample, strongest.fit, one_shape, statistic.items[item], strongest.test);
  return strongest;
}

void TestScan(const Sample& sample, const Scan& scan, Tests& tests) {
  if (auto strongest = Strongest(sample, scan)) tests.push_back(std::move(strongest->test));
}

}  // namespace twinbench::diagnose::screen
