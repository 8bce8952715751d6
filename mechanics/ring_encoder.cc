#include "mechanics/ring_encoder.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "mechanics/require.h"

namespace twinbench::mechanics {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;

void CheckRing(const Ring& ring) {
  Require(ring.radius_m > 0.0 && std::isfinite(ring.radius_m), "ring encoder: radius_m must be positive");
  Require(ring.lines > 0, "ring encoder: lines must be positive");
  Require(ring.eccentricity_m.norm() < 0.1 * ring.radius_m,
          "ring encoder: eccentricity_m must be below a tenth of the radius");
  Require(ring.tilt_rad.norm() < 0.1, "ring encoder: tilt_rad must be below 0.1");
  Require(std::abs(ring.ellipticity_m) < 0.01 * ring.radius_m,
          "ring encoder: ellipticity_m must be below a hundredth of the radius");
  Require(std::isfinite(ring.mounting_rad) && std::isfinite(ring.ellipticity_azimuth_rad),
          "ring encoder: angles must be finite");
  Check(ring.graduation, "ring encoder: graduation");
  double steepest = 0.0;
  for (const AngleHarmonic& h : ring.graduation) steepest += std::abs(h.order * h.amplitude_rad);
  Require(steepest < 0.5,
          "ring encoder: graduation must leave the lines in their order: order x amplitude below a half");
}

void CheckHead(const ReadingHead& head, const Ring& ring) {
  Require(std::isfinite(head.azimuth_rad), "ring encoder: the head's azimuth_rad must be finite");
  Require(std::abs(head.tangential_m) < 0.5 * ring.radius_m,
          "ring encoder: the head's tangential_m must be below half the radius");
  Require(std::isfinite(head.height_m), "ring encoder: the head's height_m must be finite");
  Require(std::abs(head.height_m) * ring.tilt_rad.norm() < 0.1 * ring.radius_m,
          "ring encoder: the head's height_m must be near the ring: its tilt moves it there by less than a tenth "
          "of the radius");
}

Eigen::Matrix3d About(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
}

Eigen::Matrix3d RotorToRing(const Ring& ring) {
  const Eigen::Matrix3d X_RC = About(ring.tilt_rad.x(), Eigen::Vector3d::UnitX()) *
                               About(ring.tilt_rad.y(), Eigen::Vector3d::UnitY()) *
                               About(ring.mounting_rad, Eigen::Vector3d::UnitZ());
  return X_RC.transpose();
}

/// Azimuth where the line meets the circle on the side it comes out of.
double MeetingAzimuth_rad(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction, double radius_m) {
  const double a = direction.squaredNorm();
  const double b = from_m.dot(direction);
  const double c = from_m.squaredNorm() - radius_m * radius_m;
  const Eigen::Vector2d hit_m = from_m + (std::sqrt(b * b - a * c) - b) / a * direction;
  return std::atan2(hit_m.y(), hit_m.x());
}

}  // namespace

RingEncoder::RingEncoder(const Ring& ring, const ReadingHead& head)
    : ring_((CheckRing(ring), ring)), head_((CheckHead(head, ring), head)), to_ring_(RotorToRing(ring)) {}

double RingEncoder::AngleOnRing_rad(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction) const {
  if (ring_.ellipticity_m == 0.0) return MeetingAzimuth_rad(from_m, direction, ring_.radius_m);
  double angle_rad = MeetingAzimuth_rad(from_m, direction, ring_.radius_m);
  double before_rad = angle_rad + 1.0;
  // Each round is at least 50 times nearer: 9 reach rounding, and real rings need 3.
  for (int round = 0; round < 9 && std::abs(angle_rad - before_rad) > 1e-16; ++round) {
    const double twice_rad = 2.0 * (angle_rad - ring_.ellipticity_azimuth_rad);
    const double radius_m = ring_.radius_m + ring_.ellipticity_m * std::cos(twice_rad);
    const double sideways_rad = -0.5 * ring_.ellipticity_m / ring_.radius_m * std::sin(twice_rad);
    before_rad = angle_rad;
    angle_rad = MeetingAzimuth_rad(from_m, direction, radius_m) - sideways_rad;
  }
  return angle_rad;
}

double RingEncoder::Scale_rad(double shaft_rad, const Eigen::Vector2d& radial_m) const {
  // The head's line in R: azimuth as the rotor sees it.
  const double azimuth_rad = head_.azimuth_rad - shaft_rad;
  const Eigen::Vector2d out(std::cos(azimuth_rad), std::sin(azimuth_rad));
  const Eigen::Vector2d sideways(-out.y(), out.x());
  const Eigen::Vector2d p_m = head_.tangential_m * sideways - Eigen::Rotation2Dd(-shaft_rad) * radial_m;
  const Eigen::Vector3d from_m(p_m.x() - ring_.eccentricity_m.x(), p_m.y() - ring_.eccentricity_m.y(),
                               head_.height_m);
  const Eigen::Vector3d from_ring_m = to_ring_ * from_m;
  const Eigen::Vector2d direction = to_ring_.topLeftCorner<2, 2>() * out;

  const double ideal_rad = shaft_rad - MarkAtShaft_rad();
  const double turned_rad = -AngleOnRing_rad(from_ring_m.head<2>(), direction);
  const double scale_rad = ideal_rad + std::remainder(turned_rad - ideal_rad, kTurn_rad);
  return scale_rad + Evaluate(ring_.graduation, scale_rad).value_rad;
}

double RingEncoder::Shaft_rad(double scale_rad, const Eigen::Vector2d& radial_m) const {
  double shaft_rad = scale_rad + MarkAtShaft_rad();
  // Errors have slopes below a half or no scale would count: each round halves what is left, and mostly far more.
  for (int round = 0; round < 60; ++round) {
    const double left_rad = scale_rad - Scale_rad(shaft_rad, radial_m);
    shaft_rad += left_rad;
    if (std::abs(left_rad) <= 1e-15 * kTurn_rad + 2e-16 * std::abs(shaft_rad)) break;
  }
  return shaft_rad;
}

}  // namespace twinbench::mechanics
