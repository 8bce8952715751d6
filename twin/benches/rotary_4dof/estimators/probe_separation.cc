#include "twin/benches/rotary_4dof/estimators/probe_separation.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::separate::rotary {
namespace {

using Complex = std::complex<double>;

constexpr double kTellsNothing = 0.05;  // of a singular value, probes of unit noise: u grows twenty times
constexpr Eigen::Index kMostWithCovariance = 1440;  // angles: of more the covariance takes long

/// With the covariance only where it can be used.
ErrorMotion MotionOfTurns(const Eigen::VectorXd& angle_rad, const Eigen::MatrixXd& turns) {
  ErrorMotion motion = OfTurns(angle_rad, turns);
  if (angle_rad.size() > kMostWithCovariance) motion.cov = {};
  return motion;
}

/// Turns of all probes that were read in the same ones; empty if one has none.
std::vector<Eigen::MatrixXd> TogetherOf(const ProbeTurns& mounting, const std::vector<std::size_t>& radial) {
  std::vector<Eigen::MatrixXd> together;
  for (const std::size_t c : radial) together.push_back(mounting.shown[c]);
  const bool are_alike = std::ranges::all_of(
      together, [&](const Eigen::MatrixXd& m) { return m.rows() > 0 && m.rows() == together.front().rows(); });
  return are_alike ? together : std::vector<Eigen::MatrixXd>{};
}

/// x and y of each turn: least squares over the probes.
struct InPlane {
  Eigen::MatrixXd x, y;
};

InPlane InPlaneOf(const std::vector<Eigen::MatrixXd>& shown, const std::vector<double>& at_rad) {
  Eigen::MatrixXd directions(std::ssize(shown), 2);
  for (std::size_t i = 0; i < shown.size(); ++i)
    directions.row(static_cast<Eigen::Index>(i)) << std::cos(at_rad[i]), std::sin(at_rad[i]);
  const Eigen::MatrixXd inverse = GeneralInverseOf(directions);
  InPlane plane{Eigen::MatrixXd::Zero(shown[0].rows(), shown[0].cols()), {}};
  plane.y = plane.x;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    plane.x += inverse(0, static_cast<Eigen::Index>(i)) * shown[i];
    plane.y += inverse(1, static_cast<Eigen::Index>(i)) * shown[i];
  }
  return plane;
}

Eigen::MatrixXd RotatingTurns(const Eigen::VectorXd& angle_rad, const InPlane& plane) {
  return plane.x * angle_rad.array().cos().matrix().asDiagonal() +
         plane.y * angle_rad.array().sin().matrix().asDiagonal();
}

/// Half the sum, or half the difference, of two mountings; what turns show beside is of both.
ErrorMotion HalfOf(const ErrorMotion& a, const ErrorMotion& b, double sign) {
  ErrorMotion half = a;
  half.contour = 0.5 * (a.contour + sign * b.contour);
  half.cov = a.cov.size() > 0 && b.cov.size() > 0 ? Eigen::MatrixXd(0.25 * (a.cov + b.cov)) : Eigen::MatrixXd();
  for (std::size_t k = 0; k < half.scatter.size(); ++k)
    half.scatter[k].insert(half.scatter[k].end(), b.scatter[k].begin(), b.scatter[k].end());
  return half;
}

bool AreAtTheSameAngles(const ProbeTurns& a, const ProbeTurns& b) {
  return a.angle_rad.size() == b.angle_rad.size() &&
         (a.angle_rad - b.angle_rad).cwiseAbs().maxCoeff() <
             1e-3 * units::turn / static_cast<double>(a.angle_rad.size());
}

Complex CoefficientOf(const Eigen::VectorXd& contour, Eigen::Index order) {
  const auto n = static_cast<double>(contour.size());
  Complex sum = 0.0;
  for (Eigen::Index k = 0; k < contour.size(); ++k)
    sum += contour[k] * std::polar(1.0, -units::turn * static_cast<double>((order * k) % contour.size()) / n);
  return sum / n;
}

/// One order of three unknowns - artefact, x, y - by the probes.
struct OrderSolution {
  Eigen::MatrixXcd inverse;  // 3 x probes
  bool is_lost = false;
};

OrderSolution SolveOrder(double order, const std::vector<double>& at_rad) {
  const auto probes = std::ssize(at_rad);
  Eigen::MatrixXcd a(probes, 3);
  for (Eigen::Index i = 0; i < probes; ++i) {
    const double f = at_rad[static_cast<std::size_t>(i)];
    a.row(i) << std::polar(1.0, -order * f), Complex(std::cos(f)), Complex(std::sin(f));
  }
  // What the artefact shows that x and y cannot make decides whether it is told.
  const Eigen::MatrixXcd xy = a.rightCols(2);
  const Eigen::MatrixXcd of_xy = (xy.adjoint() * xy).inverse() * xy.adjoint();
  const Eigen::VectorXcd own = a.col(0) - xy * (of_xy * a.col(0));
  OrderSolution solution{Eigen::MatrixXcd::Zero(3, probes),
                         own.squaredNorm() < kTellsNothing * kTellsNothing * static_cast<double>(probes)};
  if (!solution.is_lost) solution.inverse.row(0) = own.adjoint() / own.squaredNorm();
  solution.inverse.bottomRows(2) = of_xy - of_xy * a.col(0) * solution.inverse.row(0);
  return solution;
}

/// Means over the turns of several probes, order by order.
class ProbeHarmonics {
 public:
  ProbeHarmonics(const ProbeTurns& mounting, const std::vector<Eigen::MatrixXd>& shown,
                 const std::vector<double>& at_rad)
      : angle_rad_(mounting.angle_rad), n_(angle_rad_.size()) {
    std::vector<ErrorMotion> probes;
    for (const Eigen::MatrixXd& turns : shown) probes.push_back(OfTurns(angle_rad_, turns));
    for (auto& contour : contour_) contour = Eigen::VectorXd::Zero(n_);
    for (auto& lags : lags_) lags = Eigen::VectorXd::Zero(n_);
    for (Eigen::Index order = 2; 2 * order < n_; ++order) Take(order, probes, at_rad);
    is_known_ = probes.front().cov.size() > 0 && n_ <= kMostWithCovariance;
  }

  /// 0 artefact, 1 x, 2 y.
  ErrorMotion Motion(int which, const std::vector<std::vector<double>>& scatter) const {
    ErrorMotion motion{angle_rad_, contour_[static_cast<std::size_t>(which)], {}, scatter};
    if (!is_known_) return motion;
    motion.cov.resize(n_, n_);
    for (Eigen::Index i = 0; i < n_; ++i) {
      for (Eigen::Index j = 0; j < n_; ++j)
        motion.cov(i, j) = lags_[static_cast<std::size_t>(which)][std::abs(i - j)];
    }
    return motion;
  }
  const std::vector<int>& lost() const { return lost_; }

 private:
  void Take(Eigen::Index order, const std::vector<ErrorMotion>& probes, const std::vector<double>& at_rad) {
    const OrderSolution solution = SolveOrder(static_cast<double>(order), at_rad);
    if (solution.is_lost) lost_.push_back(static_cast<int>(order));
    Eigen::VectorXcd shown(std::ssize(probes));
    Eigen::VectorXd variance = Eigen::VectorXd::Zero(std::ssize(probes));
    for (Eigen::Index i = 0; i < shown.size(); ++i) {
      const ErrorMotion& probe = probes[static_cast<std::size_t>(i)];
      shown[i] = CoefficientOf(probe.contour, order);
      if (probe.cov.size() > 0) variance[i] = probe.cov.diagonal().mean() / static_cast<double>(n_);
    }
    const Eigen::VectorXcd found = solution.inverse * shown;
    for (Eigen::Index which = 0; which < 3; ++which) {
      const double of_order = solution.inverse.row(which).cwiseAbs2().dot(variance.transpose());
      for (Eigen::Index k = 0; k < n_; ++k) {
        const double phase = units::turn * static_cast<double>((order * k) % n_) / static_cast<double>(n_);
        contour_[static_cast<std::size_t>(which)][k] += 2.0 * (found[which] * std::polar(1.0, phase)).real();
        lags_[static_cast<std::size_t>(which)][k] += 2.0 * of_order * std::cos(phase);
      }
    }
  }

  Eigen::VectorXd angle_rad_;
  Eigen::Index n_;
  Eigen::VectorXd contour_[3], lags_[3];
  std::vector<int> lost_;
  bool is_known_ = false;
};

void ByProbes(const ProbeTurns& mounting, const std::vector<Eigen::MatrixXd>& shown,
              const std::vector<double>& at_rad, RadialMotion& radial) {
  const ProbeHarmonics harmonics(mounting, shown, at_rad);
  radial.x = harmonics.Motion(1, radial.x->scatter);
  radial.y = harmonics.Motion(2, radial.y->scatter);
  const std::vector<std::vector<double>> scatter = radial.rotating->scatter;
  radial.rotating = Rotating(*radial.x, *radial.y);
  radial.rotating->scatter = scatter;
  if (radial.x->cov.size() > 0) {
    // Of x and y apart: what their errors have in common is left out.
    const auto n = radial.x->cov.rows();
    Eigen::MatrixXd both = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    both.topLeftCorner(n, n) = radial.x->cov;
    both.bottomRightCorner(n, n) = radial.y->cov;
    radial.rotating->cov = RotatingCovariance(mounting.angle_rad, both);
  }
  radial.artefact = harmonics.Motion(0, {});
  radial.artefact->scatter.resize(static_cast<std::size_t>(mounting.angle_rad.size()));
  radial.separated_by = "probes";
  radial.lost_orders = harmonics.lost();
}

struct Mountings {
  const ProbeTurns* normal = nullptr;
  const ProbeTurns* reversed = nullptr;
};

Mountings PairOf(const std::vector<ProbeTurns>& mountings, int reversed) {
  Mountings pair;
  for (const ProbeTurns& m : mountings) {
    if (m.setup == reversed) pair.reversed = &m;
    if (m.setup != reversed && !pair.normal) pair.normal = &m;
  }
  return pair;
}

}  // namespace

RadialMotion SeparateRadial(const std::vector<ProbeTurns>& mountings, const std::vector<std::size_t>& radial,
                            const std::vector<double>& at_rad, int reversed) {
  RadialMotion result;
  const Mountings pair = PairOf(mountings, reversed);
  if (!pair.normal || radial.empty()) return result;
  const Eigen::VectorXd& angle_rad = pair.normal->angle_rad;
  const std::vector<Eigen::MatrixXd> shown = TogetherOf(*pair.normal, radial);
  if (shown.empty()) return result;
  const std::vector<Eigen::MatrixXd> again = pair.reversed && AreAtTheSameAngles(*pair.normal, *pair.reversed)
                                                 ? TogetherOf(*pair.reversed, radial)
                                                 : std::vector<Eigen::MatrixXd>{};
  if (shown.size() == 1) {
    const ErrorMotion normal = MotionOfTurns(angle_rad, shown[0]);
    result.along = normal;
    if (again.empty()) return result;
    const ErrorMotion other = MotionOfTurns(angle_rad, again[0]);
    result.along = HalfOf(normal, other, -1.0);
    result.artefact = HalfOf(normal, other, 1.0);
    result.artefact->scatter.assign(static_cast<std::size_t>(angle_rad.size()), {});
    result.separated_by = "reversal";
    return result;
  }
  const InPlane plane = InPlaneOf(shown, at_rad);
  result.x = MotionOfTurns(angle_rad, plane.x);
  result.y = MotionOfTurns(angle_rad, plane.y);
  result.rotating = MotionOfTurns(angle_rad, RotatingTurns(angle_rad, plane));
  if (!again.empty()) {
    const InPlane other = InPlaneOf(again, at_rad);
    result.x = HalfOf(*result.x, MotionOfTurns(angle_rad, other.x), -1.0);
    result.y = HalfOf(*result.y, MotionOfTurns(angle_rad, other.y), -1.0);
    result.rotating = HalfOf(*result.rotating, MotionOfTurns(angle_rad, RotatingTurns(angle_rad, other)), -1.0);
    result.artefact = HalfOf(MotionOfTurns(angle_rad, shown[0]), MotionOfTurns(angle_rad, again[0]), 1.0);
    result.artefact->scatter.assign(static_cast<std::size_t>(angle_rad.size()), {});
    result.separated_by = "reversal";
  } else if (shown.size() > 2) {
    ByProbes(*pair.normal, shown, at_rad, result);
  }
  return result;
}

}  // namespace twinbench::separate::rotary
