#include "twin/diagnose/screen/variance_components.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "twin/diagnose/screen/sizes.h"

namespace twinbench::diagnose::screen {
namespace {

/// One column a group, all sortings side by side; an offset of one stated deviation each.
struct Design {
  std::vector<Eigen::Index> start;  // first column of each sorting, and the end
  Eigen::VectorXd before;           // squared lengths of the columns
  Eigen::MatrixXd information;      // Z' W Z
  Eigen::VectorXd gradient;         // Z' W y
  double squares = 0.0, dof = 0.0;  // of what projection leaves of the channel

  Eigen::Index Groups() const { return start.back(); }
  Eigen::Index Size(Eigen::Index sorting) const { return start[sorting + 1] - start[sorting]; }
};

/// Whitened, readings x groups.
Whitening ColumnsOf(const Sample& s, const std::vector<std::vector<int>>& sortings, int channel,
                    std::vector<Eigen::Index>& start) {
  std::vector<Eigen::Triplet<double>> entries;
  start = {0};
  for (const std::vector<int>& group : sortings) {
    for (std::size_t i = 0; i < group.size(); ++i) entries.emplace_back(i, start.back() + group[i], 1.0);
    start.push_back(start.back() + *std::ranges::max_element(group) + 1);
  }
  Whitening indicator(s.run.schedule.Readings(), start.back());
  indicator.setFromTriplets(entries.begin(), entries.end());
  return s.whitening[channel] * indicator * TypicalSigma(s.run, channel);
}

/// H of the projector, some columns at a time: they are long.
Eigen::MatrixXd Absorbed(const Sample& s, const Eigen::SparseMatrix<double>& columns, int channel) {
  constexpr Eigen::Index kChunk = 64;
  Eigen::MatrixXd absorbed(s.projector.Jacobian().cols(), columns.cols());
  for (Eigen::Index first = 0; first < columns.cols(); first += kChunk) {
    const Eigen::Index count = std::min(kChunk, columns.cols() - first);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(s.run.Rows(), count);
    rows(RowsOf(s.run, channel), Eigen::all) = Eigen::MatrixXd(columns.middleCols(first, count));
    absorbed.middleCols(first, count) = s.projector.Absorbed(rows);
  }
  return absorbed;
}

Design DesignOf(const Sample& s, const std::vector<std::vector<int>>& sortings, int channel) {
  Design design;
  const Whitening columns = ColumnsOf(s, sortings, channel, design.start);
  const auto rows = RowsOf(s.run, channel);
  const Eigen::VectorXd residual = s.residual.col(0)(rows);
  const Eigen::MatrixXd absorbed = Absorbed(s, columns, channel);
  design.information = columns.transpose() * columns;
  design.before = design.information.diagonal();
  design.information.noalias() -= absorbed.transpose() * absorbed;
  design.gradient = columns.transpose() * residual;
  design.squares = residual.squaredNorm();
  design.dof = s.redundancy(rows).sum();
  return design;
}

/// The likelihood's slope and curvature at variances `ratio`, in units of that of single readings.
struct Slope {
  Eigen::VectorXd score;
  Eigen::MatrixXd information;
  double repeat = kNaN;
};

Slope SlopeAt(const Design& d, const Eigen::VectorXd& ratio) {
  const auto sortings = static_cast<Eigen::Index>(d.start.size()) - 1;
  Eigen::VectorXd prior(d.Groups());
  for (Eigen::Index k = 0; k < sortings; ++k) prior.segment(d.start[k], d.Size(k)).setConstant(ratio[k]);
  // (I + A G)^-1 takes the shares out of what the groups share.
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(Eigen::MatrixXd::Identity(d.Groups(), d.Groups()) +
                                                d.information * prior.asDiagonal());
  const Eigen::MatrixXd left = lu.solve(d.information);
  const Eigen::VectorXd gradient = lu.solve(d.gradient);
  Slope slope{Eigen::VectorXd(sortings), Eigen::MatrixXd(sortings, sortings), kNaN};
  slope.repeat = std::max(d.squares - d.gradient.dot(prior.cwiseProduct(gradient)), 1e-12 * d.squares) / d.dof;
  for (Eigen::Index k = 0; k < sortings; ++k) {
    const Eigen::Index at = d.start[k], size = d.Size(k);
    slope.score[k] =
        0.5 * (gradient.segment(at, size).squaredNorm() / slope.repeat - left.block(at, at, size, size).trace());
    for (Eigen::Index l = 0; l < sortings; ++l)
      slope.information(k, l) = 0.5 * left.block(at, d.start[l], size, d.Size(l)).squaredNorm();
  }
  return slope;
}

/// Sortings whose offsets are free unknowns say nothing.
bool Speaks(const Design& d, Eigen::Index sorting) {
  constexpr double kSurvives = 1e-3;
  const Eigen::Index at = d.start[sorting], size = d.Size(sorting);
  return d.information.diagonal().segment(at, size).sum() > kSurvives * d.before.segment(at, size).sum();
}

/// The step of Fisher scoring in the variances that speak.
Eigen::VectorXd StepOf(const Design& d, const Slope& slope) {
  Eigen::MatrixXd information = slope.information;
  Eigen::VectorXd score = slope.score;
  for (Eigen::Index k = 0; k < score.size(); ++k) {
    if (Speaks(d, k)) continue;
    information.row(k).setZero();
    information.col(k).setZero();
    information(k, k) = 1.0;
    score[k] = 0.0;
  }
  return information.ldlt().solve(score);
}

}  // namespace

VarianceComponents FitVarianceComponents(const Sample& sample, const std::vector<std::vector<int>>& sortings,
                                         int channel) {
  constexpr int kMostSteps = 30;
  constexpr double kSettled = 1e-3;  // of a variance and of that of single readings
  const Design design = DesignOf(sample, sortings, channel);
  Eigen::VectorXd ratio = Eigen::VectorXd::Zero(std::ssize(sortings));
  Slope slope = SlopeAt(design, ratio);
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::VectorXd before = ratio;
    ratio = (ratio + StepOf(design, slope)).cwiseMax(0.0);
    slope = SlopeAt(design, ratio);
    if (((ratio - before).array().abs() <= kSettled * (ratio.array() + kSettled)).all()) break;
  }
  ratio = (ratio.array() > kSettled * kSettled).select(ratio, 0.0);
  VarianceComponents components{slope.repeat * ratio, Eigen::VectorXd::Constant(ratio.size(), kNaN), slope.repeat};
  for (Eigen::Index k = 0; k < ratio.size(); ++k) {
    if (Speaks(design, k)) components.u_variance[k] = slope.repeat / std::sqrt(slope.information(k, k));
  }
  return components;
}

}  // namespace twinbench::diagnose::screen
