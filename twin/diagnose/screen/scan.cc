#include "twin/diagnose/screen/scan.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace twinbench::diagnose::screen {
namespace {

/// M with M M' the inverse of the information in the directions that survive the projection.
Eigen::MatrixXd SurvivingRoot(const Eigen::MatrixXd& information, const Eigen::VectorXd& before) {
  constexpr double kSurvives = 1e-3;
  const Eigen::VectorXd scale = (before.array() > 0.0).select(before.array().rsqrt(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * information * scale.asDiagonal());
  const auto dof = (eigen.eigenvalues().array() > kSurvives).count();
  return scale.asDiagonal() * eigen.eigenvectors().rightCols(dof) *
         eigen.eigenvalues().tail(dof).cwiseSqrt().cwiseInverse().asDiagonal();
}

void Solve(Fit& fit) {
  const Eigen::MatrixXd root = SurvivingRoot(fit.information, fit.before);
  const Eigen::VectorXd score = root.transpose() * fit.gradient;
  fit.dof = static_cast<int>(root.cols());
  fit.chi2 = score.squaredNorm();
  fit.amplitude = root * score;
  fit.cov = root * root.transpose();
}

/// Information of some items before projection; it does not mix channels.
struct Before {
  std::vector<Eigen::MatrixXd> information;  // one an item
  Eigen::MatrixXd white;                     // rows x (items * channels * width)
};

Before BeforeProjection(const Sample& s, const Scan& scan, int first, int items) {
  const int channels = s.run.Channels(), width = scan.width, size = channels * width;
  Before before{std::vector(static_cast<std::size_t>(items), Eigen::MatrixXd(Eigen::MatrixXd::Zero(size, size))),
                Eigen::MatrixXd::Zero(s.run.Rows(), items * size)};
  for (int c = 0; c < channels; ++c) {
    const Eigen::MatrixXd white =
        s.whitening[static_cast<std::size_t>(c)] * scan.ShapesOf(c).middleCols(first * width, items * width);
    const auto rows = Eigen::seqN(c, s.run.schedule.Readings(), channels);
    for (int e = 0; e < items; ++e) {
      const auto item = white.middleCols(e * width, width);
      before.white(rows, Eigen::seqN((e * channels + c) * width, width)) = item;
      before.information[static_cast<std::size_t>(e)].block(c * width, c * width, width, width) =
          item.transpose() * item;
    }
  }
  return before;
}

/// Information of each of the items [first, first + items); `before` receives the diagonals before projection.
std::vector<Eigen::MatrixXd> Information(const Sample& s, const Scan& scan, int first, int items,
                                         std::vector<Eigen::VectorXd>& before) {
  Before all = BeforeProjection(s, scan, first, items);
  const Eigen::MatrixXd absorbed = s.projector.Absorbed(all.white);
  const int size = s.run.Channels() * scan.width;
  for (int e = 0; e < items; ++e) {
    Eigen::MatrixXd& information = all.information[static_cast<std::size_t>(e)];
    before.emplace_back(information.diagonal());
    const auto h = absorbed.middleCols(e * size, size);
    information.noalias() -= h.transpose() * h;
  }
  return std::move(all.information);
}

/// S' W y of every item in one channel: (items * width) x columns.
std::vector<Eigen::MatrixXd> Gradients(const Sample& s, const Scan& scan) {
  std::vector<Eigen::MatrixXd> gradients;
  for (int c = 0; c < s.run.Channels(); ++c) {
    gradients.emplace_back(scan.ShapesOf(c).transpose() * s.adjoint[static_cast<std::size_t>(c)]);
  }
  return gradients;
}

Eigen::MatrixXd GradientOf(const std::vector<Eigen::MatrixXd>& gradients, int item, int width) {
  Eigen::MatrixXd gradient(static_cast<Eigen::Index>(gradients.size()) * width, gradients.front().cols());
  for (std::size_t c = 0; c < gradients.size(); ++c) {
    gradient.middleRows(static_cast<Eigen::Index>(c) * width, width) = gradients[c].middleRows(item * width, width);
  }
  return gradient;
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
  std::vector<Eigen::VectorXd> before;
  Fit fit;
  fit.width = scan.width;
  fit.information = Information(sample, scan, item, 1, before).front();
  fit.before = before.front();
  fit.gradient.resize(fit.before.size());
  for (int c = 0; c < sample.run.Channels(); ++c) {
    fit.gradient.segment(c * scan.width, scan.width) =
        sample.level[c] * scan.ShapesOf(c).middleCols(item * scan.width, scan.width).transpose() *
        sample.adjoint[static_cast<std::size_t>(c)].col(0);
  }
  Solve(fit);
  return fit;
}

Eigen::MatrixXd Scores(const Sample& sample, const Scan& scan) {
  const int items = scan.Items(), size = sample.run.Channels() * scan.width, chunk = std::max(1, 64 / size);
  const std::vector<Eigen::MatrixXd> gradients = Gradients(sample, scan);
  Eigen::MatrixXd scores(items, sample.Columns());
  for (int first = 0; first < items; first += chunk) {
    std::vector<Eigen::VectorXd> before;
    const auto information = Information(sample, scan, first, std::min(chunk, items - first), before);
    for (std::size_t e = 0; e < information.size(); ++e) {
      const int item = first + static_cast<int>(e);
      const Eigen::MatrixXd root = SurvivingRoot(information[e], before[e]);
      const Eigen::MatrixXd score = root.transpose() * GradientOf(gradients, item, scan.width);
      const int dof = static_cast<int>(root.cols());
      for (int j = 0; j < sample.Columns(); ++j) {
        scores(item, j) =
            dof > 0 ? NormalScore(score.col(j).squaredNorm(), dof) : -std::numeric_limits<double>::infinity();
      }
    }
  }
  return scores;
}

}  // namespace twinbench::diagnose::screen
