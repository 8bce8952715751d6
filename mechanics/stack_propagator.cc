#include "mechanics/stack_propagator.h"

#include <algorithm>
#include <cmath>

#include "mechanics/linear_step.h"
#include "mechanics/matrices.h"

namespace twinbench::mechanics {

StackPropagator::StackPropagator(const StackParameters& parameters) : period_s_(parameters.servo_period_s) {
  const StackParameters p = InPayloadFrame(parameters);
  StackDynamics dynamics(p);
  inverse_mass_ = dynamics.InverseMass(Vector12::Zero());
  mass_ = InverseOf(inverse_mass_);
  rates_.setZero();
  rates_.topRightCorner<kCoordinates, kCoordinates>().setIdentity();
  rates_.bottomLeftCorner<kCoordinates, kCoordinates>() = -inverse_mass_ * BearingStiffness(p).asDiagonal();
  rates_.bottomRightCorner<kCoordinates, kCoordinates>() = -inverse_mass_ * BearingDamping(p).asDiagonal();

  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(3 * kCoordinates, 3 * kCoordinates);
  system.topLeftCorner<2 * kCoordinates, 2 * kCoordinates>() = rates_;
  system.block<kCoordinates, kCoordinates>(kCoordinates, 2 * kCoordinates).setIdentity();
  const Eigen::MatrixXd part = ExponentialOf(system * (period_s_ / kParts));
  const Eigen::MatrixXd once = part.topLeftCorner<2 * kCoordinates, 2 * kCoordinates>();
  const Eigen::MatrixXd push = part.topRightCorner<2 * kCoordinates, kCoordinates>();
  Eigen::MatrixXd transition = Transition::Identity(), drive = Drive::Zero();
  for (std::size_t i = 0; i <= kParts; ++i) {
    transition_[i] = transition;
    drive_[i] = drive;
    transition = once * transition;
    drive = once * drive + push;
  }
}

StackPropagator::State StackPropagator::Step(const State& from, const Vector12& acceleration, int parts) const {
  State to;
  LinearStep({transition(parts).data(), drive(parts).data(), kCoordinates}, from.data(), acceleration.data(), to.data());
  return to;
}

StackPropagator::State StackPropagator::Within(const State& from, const Vector12& acceleration,
                                               double since_s) const {
  const double part_s = period_s_ / kParts;
  const int nearest = std::clamp(static_cast<int>(std::lround(since_s / part_s)), 0, kParts);
  State state = Step(from, acceleration, nearest);
  const double rest_s = since_s - nearest * part_s;
  if (rest_s == 0.0) return state;
  State term = rates_ * state;
  term.tail<kCoordinates>() += acceleration;
  term *= rest_s;
  for (int order = 2; order <= 5; ++order) {
    state += term;
    term = rest_s / order * (rates_ * term);
  }
  return state;
}

StackParameters InPayloadFrame(StackParameters p) {
  p.payload.azimuth_rad = 0.0;
  p.geometry.reseat_rad = 0.0;
  p.geometry.clamp_rad = 0.0;
  p.geometry.centring_m.setZero();
  p.geometry.mount_tilt_rad.setZero();
  return p;
}

std::array<double, 2> PayloadAzimuths(const StackParameters& p, double target_rad, double reference_rad) {
  const double body_rad = target_rad + p.geometry.reseat_rad;  // of the reference's stator
  const double in_lab_rad = IsEccentric(p) ? body_rad + reference_rad + p.payload.azimuth_rad : 0.0;
  return {in_lab_rad, in_lab_rad - body_rad};
}

Vector12 Turned(Vector12 q, const std::array<double, 2>& azimuth_rad) {
  for (int table = 0; table < 2; ++table) {
    const double azimuth = azimuth_rad[static_cast<std::size_t>(table)];
    if (azimuth == 0.0) continue;
    const Eigen::Rotation2Dd turn(azimuth);
    for (const int first : {kPerTable * table, kPerTable * table + 3}) {
      q.segment<2>(first) = (turn * Eigen::Vector2d(q.segment<2>(first))).eval();
    }
  }
  return q;
}

}  // namespace twinbench::mechanics
