#pragma once

#include <array>

#include "mechanics/stack.h"

/// Exact motion of the stack's linear part over a servo period and within it.
namespace twinbench::mechanics {

/// Bodies on their springs and dampers at small deflections, weightless and otherwise free:
///
///   d/dt (y, v) = (v, M^-1 (-K y - D v) + a),   y the twelve coordinates of StackDynamics,
///
/// solved by the matrix exponential for an acceleration `a` that is constant over a step. Coordinates stand in the
/// payload's axes (x from the axis towards it, in both bearings), where M is the same for all angles: everything
/// else in the stack is symmetric.
class StackPropagator {
 public:
  using State = Eigen::Matrix<double, 2 * kCoordinates, 1>;  // coordinates [m, rad], then their rates
  using Transition = Eigen::Matrix<double, 2 * kCoordinates, 2 * kCoordinates>;
  using Drive = Eigen::Matrix<double, 2 * kCoordinates, kCoordinates>;
  static constexpr int kParts = 8;  // of a servo period

  explicit StackPropagator(const StackParameters& parameters);

  /// State after `parts` eighths of a period, 0 to 8.
  State Step(const State& from, const Vector12& acceleration, int parts = kParts) const;

  /// State after `since_s`, from 0 to a period: by the nearest eighth and four terms of Taylor's series, within
  /// 1e-6 of the amplitude of a mode of 825 Hz.
  State Within(const State& from, const Vector12& acceleration, double since_s) const;

  /// What the linear part accelerates by in `at`, without `a`.
  Vector12 Acceleration(const State& at) const { return rates_.bottomRows<kCoordinates>() * at; }

  const Transition& transition(int parts = kParts) const { return transition_[static_cast<std::size_t>(parts)]; }
  const Drive& drive(int parts = kParts) const { return drive_[static_cast<std::size_t>(parts)]; }
  const Matrix12& mass() const { return mass_; }
  const Matrix12& inverse_mass() const { return inverse_mass_; }
  double period_s() const { return period_s_; }

 private:
  double period_s_;
  Matrix12 mass_, inverse_mass_;
  Transition rates_;
  std::array<Transition, kParts + 1> transition_;
  std::array<Drive, kParts + 1> drive_;
};

/// The stack with its payload on the x axis, nothing turned, shifted or tilted.
StackParameters InPayloadFrame(StackParameters parameters);

/// Whether a payload stands off the reference's axis, so that directions in the stack differ.
inline bool IsEccentric(const StackParameters& p) {
  return p.payload.mass_kg * p.payload.radius_m != 0.0;
}

/// Azimuths of the payload [rad] in the stators of the target (so in the laboratory) and of the reference, which
/// turns with the target. Without an eccentric payload those of the laboratory's x axis.
std::array<double, 2> PayloadAzimuths(const StackParameters& parameters, double target_rad, double reference_rad);

/// Coordinates of both bearings turned by +azimuth from the payload's axes into the stators', or back by -azimuth.
Vector12 Turned(Vector12 coordinates, const std::array<double, 2>& azimuth_rad);

}  // namespace twinbench::mechanics
