#include "twin/separate/error_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "twin/core/errors.h"
#include "twin/core/stream.h"

namespace twinbench::separate {
namespace {

constexpr double kRounding = 1e-12;  // of the largest variance: what is taken out of a contour leaves its covariance singular
constexpr int kValues = 5;           // of ErrorMotionValues, in its order
using Values = std::array<double, kValues>;

/// 1, cos, sin at each angle: the least-squares circle of a polar plot, whose radius is large beside the error motion.
Eigen::MatrixXd CircleBasis(const Eigen::VectorXd& angle_rad) {
  Eigen::MatrixXd basis(angle_rad.size(), 3);
  basis << Eigen::VectorXd::Ones(angle_rad.size()), angle_rad.array().cos().matrix(), angle_rad.array().sin().matrix();
  return basis;
}

double Width(const Eigen::VectorXd& values) {
  return values.maxCoeff() - values.minCoeff();
}

/// One plot: what is asked of it again and again.
class Plot {
 public:
  Plot(const Eigen::VectorXd& angle_rad, PlotCentre centre) : centre_(centre), basis_(CircleBasis(angle_rad)), solver_(basis_) {}

  /// The contour about the centre.
  Eigen::VectorXd Centred(const Eigen::VectorXd& contour) const {
    return centre_ == PlotCentre::kLeastSquares ? WithoutCircle(contour) : contour;
  }
  Eigen::VectorXd WithoutCircle(const Eigen::VectorXd& contour) const { return contour - basis_ * solver_.solve(contour); }
  double Fundamental(const Eigen::VectorXd& contour) const { return 2.0 * solver_.solve(contour).tail<2>().norm(); }

  Values Of(const Eigen::VectorXd& contour, const std::vector<std::vector<double>>& scatter) const {
    const bool is_axial = centre_ == PlotCentre::kPolarChart;
    const Eigen::VectorXd centred = Centred(contour);
    double highest = -std::numeric_limits<double>::infinity(), lowest = -highest, widest = 0.0;
    bool has_turns = true, has_pairs = true;
    for (Eigen::Index i = 0; i < centred.size(); ++i) {
      const std::vector<double>& turns = scatter[static_cast<std::size_t>(i)];
      has_turns = has_turns && !turns.empty();
      has_pairs = has_pairs && turns.size() > 1;
      if (turns.empty()) continue;
      const auto [least, most] = std::ranges::minmax(turns);
      highest = std::max(highest, centred[i] + most);
      lowest = std::min(lowest, centred[i] + least);
      widest = std::max(widest, most - least);
    }
    return {has_turns ? highest - lowest : kNaN, Width(centred), has_pairs ? widest : kNaN, is_axial ? Fundamental(contour) : kNaN,
            is_axial ? Width(WithoutCircle(contour)) : kNaN};
  }

  /// d (width of the contour) / d contour.
  Eigen::VectorXd Slope(const Eigen::VectorXd& contour) const {
    Eigen::Index most = 0, least = 0;
    const Eigen::VectorXd centred = Centred(contour);
    centred.maxCoeff(&most);
    centred.minCoeff(&least);
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(contour.size());
    slope[most] += 1.0;
    slope[least] -= 1.0;
    return Centred(slope);  // taking the circle off is symmetric
  }

 private:
  PlotCentre centre_;
  Eigen::MatrixXd basis_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver_;
};

double StandardDeviation(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const Eigen::Map<const Eigen::ArrayXd> all(values.data(), std::ssize(values));
  return std::sqrt((all - all.mean()).square().sum() / static_cast<double>(all.size() - 1));
}

/// Draws the test again.
class Repeated {
 public:
  Repeated(const ErrorMotion& motion, std::uint64_t seed) : motion_(motion), normal_(seed, "iso230_7.replicas") {
    const double largest = motion.cov.size() > 0 ? motion.cov.diagonal().maxCoeff() : 0.0;
    if (largest > 0.0)
      root_ = Eigen::LLT<Eigen::MatrixXd>(motion.cov + kRounding * largest * Eigen::MatrixXd::Identity(motion.cov.rows(), motion.cov.cols())).matrixL();
    for (const std::vector<double>& turns : motion.scatter) deviation_.push_back(StandardDeviation(turns));
  }

  Eigen::VectorXd Contour() {
    if (root_.size() == 0) return motion_.contour;
    Eigen::VectorXd drawn(motion_.contour.size());
    for (double& d : drawn) d = normal_.Normal();
    return motion_.contour + root_ * drawn;
  }

  std::vector<std::vector<double>> Scatter() {
    std::vector<std::vector<double>> drawn = motion_.scatter;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      for (double& turn : drawn[i]) turn = deviation_[i] * normal_.Normal();
    }
    return drawn;
  }

 private:
  const ErrorMotion& motion_;
  Stream normal_;
  Eigen::MatrixXd root_;
  std::vector<double> deviation_;
};

void RequireWhole(const ErrorMotion& m) {
  const Eigen::Index n = m.angle_rad.size();
  Require(m.contour.size() == n && std::ssize(m.scatter) == n, "contour and scatter need a value an angle");
  Require(m.cov.size() == 0 || (m.cov.rows() == n && m.cov.cols() == n), "the covariance needs a row an angle");
  Require(m.angle_rad.allFinite() && m.contour.allFinite() && m.cov.allFinite(), "an error motion is finite");
  for (const std::vector<double>& turns : m.scatter)
    Require(std::ranges::all_of(turns, [](double t) { return std::isfinite(t); }), "the scatter is finite");
}

/// Standard deviation and bias of every value over the replicas.
std::array<ErrorMotionValue, kValues> WithReplicas(const ErrorMotion& motion, const Plot& plot, const Values& values,
                                                   const ErrorMotionReplicas& replicas) {
  Eigen::ArrayXXd drawn(replicas.number, kValues);
  Repeated test(motion, replicas.seed);
  for (int r = 0; r < replicas.number; ++r) {
    const Eigen::VectorXd contour = test.Contour();
    const Values again = plot.Of(contour, test.Scatter());
    for (int v = 0; v < kValues; ++v) drawn(r, v) = again[static_cast<std::size_t>(v)];
  }
  std::array<ErrorMotionValue, kValues> with;
  for (int v = 0; v < kValues; ++v) {
    const double mean = drawn.col(v).mean(), value = values[static_cast<std::size_t>(v)];
    with[static_cast<std::size_t>(v)] = {value, std::sqrt((drawn.col(v) - mean).square().sum() / (replicas.number - 1)), mean - value};
  }
  return with;
}

}  // namespace

ErrorMotion Rotating(const ErrorMotion& x, const ErrorMotion& y, const Eigen::MatrixXd& cov) {
  Require(x.angle_rad.size() == y.angle_rad.size() && x.angle_rad == y.angle_rad, "x and y are at the same angles");
  const Eigen::Index n = x.angle_rad.size();
  const Eigen::ArrayXd c = x.angle_rad.array().cos(), s = x.angle_rad.array().sin();
  ErrorMotion r{x.angle_rad, (c * x.contour.array() + s * y.contour.array()).matrix(), {}, {}};
  if (cov.size() > 0) {
    Eigen::MatrixXd turn(n, 2 * n);
    turn << Eigen::MatrixXd(c.matrix().asDiagonal()), Eigen::MatrixXd(s.matrix().asDiagonal());
    r.cov = turn * cov * turn.transpose();
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::vector<double>&dx = x.scatter[static_cast<std::size_t>(i)], &dy = y.scatter[static_cast<std::size_t>(i)];
    Require(dx.size() == dy.size(), "every turn shows x and y");
    std::vector<double>& turns = r.scatter.emplace_back();
    for (std::size_t k = 0; k < dx.size(); ++k) turns.push_back(c[i] * dx[k] + s[i] * dy[k]);
  }
  return r;
}

ErrorMotionValues EvaluateErrorMotion(const ErrorMotion& motion, PlotCentre centre, const ErrorMotionReplicas& replicas) {
  RequireWhole(motion);
  ErrorMotionValues found;
  if (motion.angle_rad.size() < 3) return found;
  const Plot plot(motion.angle_rad, centre);
  const Values values = plot.Of(motion.contour, motion.scatter);
  std::array<ErrorMotionValue, kValues> with = WithReplicas(motion, plot, values, replicas);
  constexpr std::size_t kAsynchronous = 2;  // alone knows nothing of the contour
  for (std::size_t v = 0; v < kValues; ++v) {
    if (motion.cov.size() == 0 && v != kAsynchronous) with[v].u = with[v].bias = kNaN;
  }
  found = {with[0], with[1], with[2], with[3], with[4], std::numeric_limits<int>::max(), plot.Slope(motion.contour)};
  for (const std::vector<double>& turns : motion.scatter) found.turns = std::min(found.turns, static_cast<int>(turns.size()));
  return found;
}

}  // namespace twinbench::separate
