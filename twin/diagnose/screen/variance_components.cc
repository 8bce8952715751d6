#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/estimators.h"

namespace twinbench::diagnose::screen {
namespace {

/// One column a group, all sortings side by side; an offset of one stated deviation each.
struct Design {
  Eigen::SparseMatrix<double> columns;  // readings x groups, whitened
  std::vector<Eigen::Index> start;      // first column of each sorting, and the end
  std::vector<bool> speaks;             // of each sorting: its offsets are no free unknowns
  Eigen::MatrixXd information;          // Z' W Z
  Eigen::VectorXd gradient;             // Z' W y
  double squares = 0.0, dof = 0.0;      // of what projection leaves of the channel

  Eigen::Index Size(int sorting) const { return start[sorting + 1] - start[sorting]; }
};

void SetColumns(const Sample& s, const std::vector<std::vector<int>>& sortings, int channel, Design& design) {
  std::vector<Eigen::Triplet<double>> entries;
  design.start = {0};
  for (const std::vector<int>& group : sortings) {
    for (std::size_t i = 0; i < group.size(); ++i) entries.emplace_back(i, design.start.back() + group[i], 1.0);
    design.start.push_back(design.start.back() + *std::ranges::max_element(group) + 1);
  }
  Whitening indicator(s.run.schedule.Readings(), design.start.back());
  indicator.setFromTriplets(entries.begin(), entries.end());
  design.columns = s.whitening[channel] * indicator * TypicalSigma(s.run, channel);
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
  constexpr double kSurvives = 1e-3;
  Design d;
  SetColumns(s, sortings, channel, d);
  const Eigen::VectorXd residual = s.residual.col(0)(RowsOf(s.run, channel));
  const Eigen::MatrixXd absorbed = Absorbed(s, d.columns, channel);
  d.information = d.columns.transpose() * d.columns;
  const Eigen::VectorXd before = d.information.diagonal();
  d.information.noalias() -= absorbed.transpose() * absorbed;
  d.gradient = d.columns.transpose() * residual;
  d.squares = residual.squaredNorm();
  d.dof = s.redundancy(RowsOf(s.run, channel)).sum();
  const Eigen::VectorXd left = d.information.diagonal();
  for (int k = 0; k < std::ssize(sortings); ++k)
    d.speaks.push_back(left.segment(d.start[k], d.Size(k)).sum() >
                       kSurvives * before.segment(d.start[k], d.Size(k)).sum());
  return d;
}

/// The likelihood's slope and curvature at variances `ratio`, in units of that of single readings; flat in sortings
/// that do not speak, so that they stay zero.
struct Slope {
  Eigen::VectorXd score;
  Eigen::MatrixXd information;
  double repeat = kNaN;
};

Slope SlopeAt(const Design& d, const Eigen::VectorXd& ratio) {
  const auto sortings = static_cast<int>(ratio.size());
  Eigen::VectorXd prior(d.gradient.size());
  for (int k = 0; k < sortings; ++k) prior.segment(d.start[k], d.Size(k)).setConstant(ratio[k]);
  // (I + A G)^-1 takes the shares out of what the groups share.
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(Eigen::MatrixXd::Identity(prior.size(), prior.size()) +
                                                d.information * prior.asDiagonal());
  const Eigen::MatrixXd left = lu.solve(d.information);
  const Eigen::VectorXd gradient = lu.solve(d.gradient);
  Slope slope{Eigen::VectorXd::Zero(sortings), Eigen::MatrixXd::Identity(sortings, sortings), kNaN};
  slope.repeat = std::max(d.squares - d.gradient.dot(prior.cwiseProduct(gradient)), 1e-12 * d.squares) / d.dof;
  for (int k = 0; k < sortings; ++k) {
    if (!d.speaks[k]) continue;
    const double trace = left.diagonal().segment(d.start[k], d.Size(k)).sum();
    slope.score[k] = 0.5 * (gradient.segment(d.start[k], d.Size(k)).squaredNorm() / slope.repeat - trace);
    for (int l = 0; l < sortings; ++l) {
      if (d.speaks[l])
        slope.information(k, l) = 0.5 * left.block(d.start[k], d.start[l], d.Size(k), d.Size(l)).squaredNorm();
    }
  }
  return slope;
}

}  // namespace

VarianceComponents FitVarianceComponents(const Sample& sample, const std::vector<std::vector<int>>& sortings,
                                         int channel) {
  constexpr int kMostSteps = 30;
  constexpr double kSettled = 1e-3;  // of a variance and of that of single readings
  const Design design = DesignOf(sample, sortings, channel);
  Eigen::VectorXd ratio = Eigen::VectorXd::Zero(std::ssize(sortings)), before;
  Slope slope = SlopeAt(design, ratio);
  for (int step = 0; step < kMostSteps; ++step) {
    before = ratio;
    ratio = (ratio + slope.information.ldlt().solve(slope.score)).cwiseMax(0.0);
    slope = SlopeAt(design, ratio);
    if (((ratio - before).array().abs() <= kSettled * (ratio.array() + kSettled)).all()) break;
  }
  ratio = (ratio.array() > kSettled * kSettled).select(ratio, 0.0);
  VarianceComponents components{slope.repeat * ratio, Eigen::VectorXd::Constant(ratio.size(), kNaN), slope.repeat};
  for (int k = 0; k < ratio.size(); ++k) {
    if (design.speaks[k]) components.u_variance[k] = slope.repeat / std::sqrt(slope.information(k, k));
  }
  return components;
}

}  // namespace twinbench::diagnose::screen
