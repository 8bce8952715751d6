#include "twin/benches/rotary_4dof/parts_of_results.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "twin/separate/error_motion.h"

namespace twinbench::benches::rotary {
namespace {

using report::DirectedMotion;
using separate::ErrorMotion;
using separate::TableEstimate;

constexpr Eigen::Index kMostWithUncertainty = 720;  // positions; a covariance of more takes long to take the root of
constexpr const char* kAtStops = "the axis stood at every reading; the standard measures while it turns";

/// Covariances of a contour: of the readings, and of what is common to all of them.
struct ContourCovariance {
  Eigen::MatrixXd random, systematic;
};

std::optional<Eigen::Index> BlockOf(const TableEstimate& estimate, Component component) {
  const auto found = std::ranges::find(estimate.components, component);
  if (found == estimate.components.end()) return std::nullopt;
  return found - estimate.components.begin();
}

/// Positions at which a component has a value.
std::vector<Eigen::Index> Determined(const TableEstimate& estimate, const std::vector<Component>& components) {
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < estimate.value.position_rad.size(); ++i) {
    if (std::ranges::all_of(components, [&](Component c) { return std::isfinite(estimate.value[c][i]); }))
      rows.push_back(static_cast<Eigen::Index>(i));
  }
  return rows;
}

Eigen::MatrixXd Picked(const separate::CurveCovariance& cov, const std::vector<Eigen::Index>& rows) {
  if (cov.rows() == 0) return Eigen::MatrixXd::Zero(std::ssize(rows), std::ssize(rows));
  Eigen::MatrixXd picked(std::ssize(rows), std::ssize(rows));
  for (Eigen::Index r = 0; r < picked.rows(); ++r) {
    for (Eigen::Index c = 0; c < picked.cols(); ++c) picked(r, c) = cov(rows[static_cast<std::size_t>(r)], rows[static_cast<std::size_t>(c)]);
  }
  return picked;
}

/// Of some components at some positions, one component after the other; empty where it is not known.
ContourCovariance CovarianceOf(const TableEstimate& estimate, const std::vector<Component>& components,
                               const std::vector<Eigen::Index>& at) {
  const auto n = static_cast<Eigen::Index>(estimate.value.position_rad.size());
  if (n > kMostWithUncertainty) return {};
  std::vector<Eigen::Index> rows;
  for (const Component c : components) {
    for (const Eigen::Index i : at) rows.push_back(*BlockOf(estimate, c) * n + i);
  }
  ContourCovariance cov{Picked(estimate.cov, rows), Picked(estimate.cov_systematic, rows)};
  if (!cov.random.allFinite() || !cov.systematic.allFinite()) return {};
  return cov;
}

/// Which of some angles lies nearest to another, turns apart.
class NearestOnCircle {
 public:
  /// @param angle_rad  Not empty, in any order.
  explicit NearestOnCircle(const std::vector<double>& angle_rad) {
    for (std::size_t i = 0; i < angle_rad.size(); ++i) sorted_.emplace_back(WithinTurn(angle_rad[i]), i);
    std::ranges::sort(sorted_);
  }

  std::size_t operator()(double angle_rad) const {
    const double within = WithinTurn(angle_rad);
    const auto above = std::ranges::lower_bound(sorted_, within, {}, [](const auto& one) { return one.first; });
    const auto& next = above == sorted_.end() ? sorted_.front() : *above;
    const auto& last = above == sorted_.begin() ? sorted_.back() : *(above - 1);
    return std::abs(std::remainder(within - next.first, units::turn)) < std::abs(std::remainder(within - last.first, units::turn)) ? next.second
                                                                                                                          : last.second;
  }

 private:
  static double WithinTurn(double angle_rad) { return angle_rad - units::turn * std::floor(angle_rad / units::turn); }
  std::vector<std::pair<double, std::size_t>> sorted_;
};

/// What each pass shows beyond the model, by the target's position.
class PassesBeyond {
 public:
  PassesBeyond(const separate::Separation& separation, const std::vector<measure::Motion>& motions)
      : separation_(separation), motions_(motions) {}

  std::vector<std::vector<double>> Of(Component component) const { return Of(component, component); }

  /// Of the readings that show both components, as a direction that turns needs them.
  /// @return one list a position of the target; empty ones if the fit leaves nothing to judge one of the two by.
  std::vector<std::vector<double>> Of(Component component, Component beside) const {
    const std::vector<double>& angle_rad = separation_.target.value.position_rad;
    std::vector<std::vector<double>> at(angle_rad.size());
    const Eigen::Index d = IndexOf(component), other = IndexOf(beside);
    const double dof = separation_.dof_of[d], readings = separation_.readings;
    if (!(dof > 0.0) || !(separation_.dof_of[other] > 0.0)) return at;
    const NearestOnCircle nearest(angle_rad);
    const double scale = std::sqrt(readings / dof);
    for (std::size_t k = 0; k < motions_.size(); ++k) {
      const double beyond = separation_.residuals[k][d];
      if (std::isfinite(beyond) && std::isfinite(separation_.residuals[k][other]))
        at[nearest(motions_[k].target_rad)].push_back(scale * beyond);
    }
    return at;
  }

 private:
  static Eigen::Index IndexOf(Component component) {
    return std::ranges::find(separate::kComponentOf, component) - separate::kComponentOf.begin();
  }

  const separate::Separation& separation_;
  const std::vector<measure::Motion>& motions_;
};

std::vector<std::vector<double>> At(const std::vector<Eigen::Index>& positions, const std::vector<std::vector<double>>& all) {
  std::vector<std::vector<double>> some;
  for (const Eigen::Index i : positions) some.push_back(all.empty() ? std::vector<double>{} : all[static_cast<std::size_t>(i)]);
  return some;
}

ErrorMotion MotionOf(const TableEstimate& estimate, Component component, const std::vector<Eigen::Index>& at,
                     const std::vector<std::vector<double>>& scatter) {
  ErrorMotion motion{Eigen::VectorXd(std::ssize(at)), Eigen::VectorXd(std::ssize(at)), {}, At(at, scatter)};
  for (Eigen::Index k = 0; k < std::ssize(at); ++k) {
    const auto i = static_cast<std::size_t>(at[static_cast<std::size_t>(k)]);
    motion.angle_rad[k] = estimate.value.position_rad[i];
    motion.contour[k] = estimate.value[component][i];
  }
  return motion;
}

/// A component as it stands.
void AppendSingle(const char* name, const TableEstimate& estimate, Component component, const std::vector<std::vector<double>>& scatter,
                  std::vector<DirectedMotion>& all) {
  if (!BlockOf(estimate, component)) return;
  const std::vector<Eigen::Index> at = Determined(estimate, {component});
  const ContourCovariance cov = CovarianceOf(estimate, {component}, at);
  DirectedMotion directed{name, IsAngle(component), MotionOf(estimate, component, at, scatter)};
  directed.motion.cov = cov.random + cov.systematic;
  if (cov.random.size() > 0) directed.parts = {{"noise", cov.random}, {"calibration", cov.systematic}};
  all.push_back(directed);
}

/// x and y along a direction that turns forward (+1: with the rotor, seen from the laboratory) or back (-1).
void AppendTurned(const char* name, const TableEstimate& estimate, Component x, Component y, double sense,
                  const std::vector<std::vector<double>>& scatter_x, const std::vector<std::vector<double>>& scatter_y,
                  std::vector<DirectedMotion>& all) {
  if (!BlockOf(estimate, x) || !BlockOf(estimate, y)) return;
  const std::vector<Eigen::Index> at = Determined(estimate, {x, y});
  const ContourCovariance cov = CovarianceOf(estimate, {x, y}, at);
  ErrorMotion along_x = MotionOf(estimate, x, at, scatter_x), along_y = MotionOf(estimate, y, at, scatter_y);
  along_x.angle_rad *= sense;
  along_y.angle_rad *= sense;
  DirectedMotion turned{name, IsAngle(x), Rotating(along_x, along_y)};
  if (cov.random.size() > 0) {
    turned.parts = {{"noise", separate::RotatingCovariance(along_x.angle_rad, cov.random)},
                    {"calibration", separate::RotatingCovariance(along_x.angle_rad, cov.systematic)}};
    turned.motion.cov = turned.parts[0].second + turned.parts[1].second;
  }
  all.push_back(turned);
}

std::vector<DirectedMotion> OfTarget(const separate::Separation& s, const std::vector<measure::Motion>& motions) {
  const PassesBeyond passes(s, motions);
  std::vector<DirectedMotion> all;
  AppendSingle("radial_fixed_y", s.target, Component::kDy, passes.Of(Component::kDy), all);
  AppendSingle("tilt_fixed_x", s.target, Component::kEx, passes.Of(Component::kEx), all);
  AppendSingle("tilt_fixed_y", s.target, Component::kEy, passes.Of(Component::kEy), all);
  AppendTurned("tilt_rotating_x", s.target, Component::kEx, Component::kEy, +1.0, passes.Of(Component::kEx, Component::kEy),
               passes.Of(Component::kEy, Component::kEx), all);
  return all;
}

std::vector<DirectedMotion> OfReference(const TableEstimate& reference) {
  std::vector<DirectedMotion> all;
  AppendSingle("radial_rotating_x", reference, Component::kDx, {}, all);
  AppendSingle("radial_rotating_y", reference, Component::kDy, {}, all);
  AppendTurned("radial_fixed_x", reference, Component::kDx, Component::kDy, -1.0, {}, {}, all);
  AppendSingle("tilt_rotating_x", reference, Component::kEx, {}, all);
  AppendSingle("tilt_rotating_y", reference, Component::kEy, {}, all);
  AppendTurned("tilt_fixed_x", reference, Component::kEx, Component::kEy, -1.0, {}, {}, all);
  return all;
}

}  // namespace

report::ErrorMotionTexts EvaluateErrorMotions(const separate::Separation& separation, const std::vector<measure::Motion>& motions) {
  report::ErrorMotionTexts results;
  separate::ErrorMotionDraws draws;
  std::vector<DirectedMotion> of_target = OfTarget(separation, motions), of_reference = OfReference(separation.reference);
  for (std::vector<DirectedMotion>* of_table : {&of_target, &of_reference})
    for (DirectedMotion& d : *of_table) d.dof = separation.dof;
  AppendErrorMotions("target", of_target, {kAtStops}, draws, results);
  AppendErrorMotions("reference", of_reference, {kAtStops}, draws, results);
  return results;
}

}  // namespace twinbench::benches::rotary
