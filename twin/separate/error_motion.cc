#include "twin/separate/error_motion.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/separate/widest_range.h"

namespace twinbench::separate {
namespace {

constexpr double kRounding = 1e-12;  // of the largest variance: what is taken out of a contour leaves its covariance singular

/// 1, cos, sin at each angle: the least-squares circle of a polar plot, whose radius is large beside the error motion.
Eigen::MatrixXd CircleBasis(const Eigen::VectorXd& angle_rad) {
  Eigen::MatrixXd basis(angle_rad.size(), 3);
  basis << Eigen::VectorXd::Ones(angle_rad.size()), angle_rad.array().cos().matrix(), angle_rad.array().sin().matrix();
  return basis;
}

/// Largest less smallest number of each column.
Eigen::RowVectorXd Widths(const Eigen::MatrixXd& contours) {
  return contours.colwise().maxCoeff() - contours.colwise().minCoeff();
}

/// Polar plots on the same angles; contours are columns.
class Plot {
 public:
  Plot(const Eigen::VectorXd& angle_rad, PlotCentre centre)
      : is_axial_(centre == PlotCentre::kPolarChart),
        basis_(CircleBasis(angle_rad)),
        fit_(GeneralInverseOf(basis_)) {}

  bool IsAxial() const { return is_axial_; }
  /// The contours about the centre.
  Eigen::MatrixXd Centred(const Eigen::MatrixXd& contours) const { return is_axial_ ? contours : WithoutCircle(contours); }
  Eigen::MatrixXd WithoutCircle(const Eigen::MatrixXd& contours) const { return contours - basis_ * (fit_ * contours); }
  Eigen::RowVectorXd Fundamentals(const Eigen::MatrixXd& contours) const {
    return 2.0 * (fit_.bottomRows<2>() * contours).colwise().norm();
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
  bool is_axial_;
  Eigen::MatrixXd basis_, fit_;
};

double StandardDeviation(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const Eigen::Map<const Eigen::ArrayXd> all(values.data(), std::ssize(values));
  return std::sqrt((all - all.mean()).square().sum() / static_cast<double>(all.size() - 1));
}

/// What the turns show at each angle.
struct Turns {
  std::vector<int> number;
  Eigen::VectorXd most, least, deviation;  // NaN, NaN, 0 where there are none
  int fewest = std::numeric_limits<int>::max();
};

Turns TurnsOf(const std::vector<std::vector<double>>& scatter) {
  const auto n = std::ssize(scatter);
  Turns turns{{}, Eigen::VectorXd::Constant(n, kNaN), Eigen::VectorXd::Constant(n, kNaN), Eigen::VectorXd::Zero(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::vector<double>& here = scatter[static_cast<std::size_t>(i)];
    turns.number.push_back(static_cast<int>(here.size()));
    turns.fewest = std::min(turns.fewest, turns.number.back());
    if (here.empty()) continue;
    const auto [least, most] = std::ranges::minmax(here);
    turns.least[i] = least;
    turns.most[i] = most;
    turns.deviation[i] = StandardDeviation(here);
  }
  return turns;
}

/// A value that came out as `drawn` when the test was repeated.
ErrorMotionValue Repeated(double value, const Eigen::ArrayXd& drawn) {
  const double mean = drawn.mean();
  return {value, std::sqrt((drawn - mean).square().sum() / static_cast<double>(drawn.size() - 1)), mean - value};
}

/// Draws the contour by its covariance.
Eigen::MatrixXd Contours(const ErrorMotion& motion, ErrorMotionDraws& draws) {
  const Eigen::MatrixXd& normal = draws.Contour(motion.contour.size());
  const double largest = motion.cov.diagonal().maxCoeff();
  Eigen::MatrixXd drawn = Eigen::MatrixXd::Zero(normal.rows(), normal.cols());
  if (largest > 0.0) {
    const Eigen::MatrixXd root = CholeskyFactorOf(motion.cov + kRounding * largest * Eigen::MatrixXd::Identity(motion.cov.rows(), motion.cov.cols()));
    drawn = root.triangularView<Eigen::Lower>() * normal;
  }
  return drawn.colwise() + motion.contour;
}

/// Width of the ring that holds every turn, of each drawn test.
Eigen::RowVectorXd Totals(const Eigen::MatrixXd& centred, const Turns& turns, ErrorMotionDraws& draws) {
  const ErrorMotionDraws::Extremes& drawn = draws.Turns(turns.number);
  return (centred + turns.deviation.asDiagonal() * drawn.most).colwise().maxCoeff() -
         (centred + turns.deviation.asDiagonal() * drawn.least).colwise().minCoeff();
}

ErrorMotionValue Asynchronous(const Turns& turns) {
  if (turns.fewest < 2) return {};
  std::vector<NormalSample> samples;
  for (std::size_t i = 0; i < turns.number.size(); ++i) samples.push_back({turns.deviation[static_cast<Eigen::Index>(i)], turns.number[i]});
  const double value = (turns.most - turns.least).maxCoeff();
  const WidestRange widest = WidestOf(samples);
  return {value, widest.deviation, widest.mean - value};
}

/// Values without their uncertainties.
ErrorMotionValues AsTheyStand(const ErrorMotion& motion, const Plot& plot, const Turns& turns) {
  const Eigen::VectorXd centred = plot.Centred(motion.contour);
  ErrorMotionValues found;
  found.turns = turns.fewest;
  found.slope = plot.Slope(motion.contour);
  found.synchronous.value = Widths(centred)[0];
  if (turns.fewest > 0) found.total.value = (centred + turns.most).maxCoeff() - (centred + turns.least).minCoeff();
  if (plot.IsAxial()) {
    found.fundamental.value = plot.Fundamentals(motion.contour)[0];
    found.residual.value = Widths(plot.WithoutCircle(motion.contour))[0];
  }
  found.asynchronous = Asynchronous(turns);
  return found;
}

/// Adds what repeated tests say of the values that know of the contour.
void Repeat(const ErrorMotion& motion, const Plot& plot, const Turns& turns, ErrorMotionDraws& draws, ErrorMotionValues& found) {
  const Eigen::MatrixXd contours = Contours(motion, draws), centred = plot.Centred(contours);
  found.synchronous = Repeated(found.synchronous.value, Widths(centred));
  if (turns.fewest > 0) found.total = Repeated(found.total.value, Totals(centred, turns, draws));
  if (!plot.IsAxial()) return;
  found.fundamental = Repeated(found.fundamental.value, plot.Fundamentals(contours));
  found.residual = Repeated(found.residual.value, Widths(plot.WithoutCircle(contours)));
}

void RequireWhole(const ErrorMotion& m) {
  const Eigen::Index n = m.angle_rad.size();
  Require(m.contour.size() == n && std::ssize(m.scatter) == n, "contour and scatter need a value an angle");
  Require(m.cov.size() == 0 || (m.cov.rows() == n && m.cov.cols() == n), "the covariance needs a row an angle");
  Require(m.angle_rad.allFinite() && m.contour.allFinite() && m.cov.allFinite(), "an error motion is finite");
  for (const std::vector<double>& turns : m.scatter)
    Require(std::ranges::all_of(turns, [](double t) { return std::isfinite(t); }), "the scatter is finite");
}

}  // namespace

ErrorMotion OfTurns(const Eigen::VectorXd& angle_rad, const Eigen::MatrixXd& turns) {
  Require(turns.rows() > 0 && turns.cols() == angle_rad.size(), "a turn has a value an angle");
  ErrorMotion motion{angle_rad, turns.colwise().mean().transpose(), {}, {}};
  const Eigen::MatrixXd beside = turns.rowwise() - turns.colwise().mean();
  for (const auto& at : beside.colwise()) motion.scatter.emplace_back(at.begin(), at.end());
  if (turns.rows() == 1) return motion;
  const double variance = beside.squaredNorm() / static_cast<double>((turns.rows() - 1) * turns.cols());
  motion.cov = variance / static_cast<double>(turns.rows()) * Eigen::MatrixXd::Identity(turns.cols(), turns.cols());
  return motion;
}

ErrorMotion Rotating(const ErrorMotion& x, const ErrorMotion& y) {
  Require(x.angle_rad.size() == y.angle_rad.size() && x.angle_rad == y.angle_rad, "x and y are at the same angles");
  const Eigen::ArrayXd c = x.angle_rad.array().cos(), s = x.angle_rad.array().sin();
  ErrorMotion r{x.angle_rad, (c * x.contour.array() + s * y.contour.array()).matrix(), {}, {}};
  for (Eigen::Index i = 0; i < x.angle_rad.size(); ++i) {
    const std::vector<double>&dx = x.scatter[static_cast<std::size_t>(i)], &dy = y.scatter[static_cast<std::size_t>(i)];
    Require(dx.size() == dy.size(), "every turn shows x and y");
    std::vector<double>& turns = r.scatter.emplace_back();
    for (std::size_t k = 0; k < dx.size(); ++k) turns.push_back(c[i] * dx[k] + s[i] * dy[k]);
  }
  return r;
}

Eigen::MatrixXd RotatingCovariance(const Eigen::VectorXd& angle_rad, const Eigen::MatrixXd& cov) {
  const Eigen::Index n = angle_rad.size();
  Require(cov.rows() == 2 * n && cov.cols() == 2 * n, "the covariance has a row for x and for y at every angle");
  const Eigen::VectorXd c = angle_rad.array().cos(), s = angle_rad.array().sin();
  return c.asDiagonal() * cov.topLeftCorner(n, n) * c.asDiagonal() + Eigen::MatrixXd(c.asDiagonal() * cov.topRightCorner(n, n) * s.asDiagonal()) +
         Eigen::MatrixXd(s.asDiagonal() * cov.bottomLeftCorner(n, n) * c.asDiagonal()) +
         Eigen::MatrixXd(s.asDiagonal() * cov.bottomRightCorner(n, n) * s.asDiagonal());
}

ErrorMotionValues EvaluateErrorMotion(const ErrorMotion& motion, PlotCentre centre, ErrorMotionDraws& draws) {
  RequireWhole(motion);
  if (motion.angle_rad.size() < 3) return {};
  const Plot plot(motion.angle_rad, centre);
  const Turns turns = TurnsOf(motion.scatter);
  ErrorMotionValues found = AsTheyStand(motion, plot, turns);
  if (motion.cov.size() > 0) Repeat(motion, plot, turns, draws, found);
  return found;
}

ErrorMotionValues EvaluateErrorMotion(const ErrorMotion& motion, PlotCentre centre, const ErrorMotionReplicas& replicas) {
  ErrorMotionDraws draws(replicas);
  return EvaluateErrorMotion(motion, centre, draws);
}

}  // namespace twinbench::separate
