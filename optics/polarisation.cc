#include "optics/polarisation.h"

#include <Eigen/Geometry>
#include <cmath>
#include <complex>
#include <stdexcept>

namespace twinbench::optics {
namespace {

using Eigen::Vector3d;

/// Across the ray; zero if the axis lies along it.
Vector3d Across(const Vector3d& axis, const Vector3d& direction) {
  const Vector3d across = axis - axis.dot(direction) * direction;
  const double length = across.norm();
  constexpr double kAlong = 1e-9;
  return length > kAlong ? Vector3d(across / length) : Vector3d(Vector3d::Zero());
}

/// Real amplitude of a field along a unit vector (no conjugate: the vector is real).
std::complex<double> Along(const Field& field, const Vector3d& axis) {
  return field.x() * axis.x() + field.y() * axis.y() + field.z() * axis.z();
}

/// Across the plane of incidence, where any direction does if the ray stands on the surface; or along the wires.
Vector3d SAxis(const PolarisingSplitter& splitter, const Vector3d& direction, const Vector3d& normal) {
  if (!splitter.wires.isZero()) return Across(splitter.wires, direction);
  const Vector3d s = direction.cross(normal);
  return s.squaredNorm() > 1e-24 ? s.normalized() : direction.unitOrthogonal();
}

Vector3d Mirrored(const Vector3d& v, const Vector3d& normal) {
  return v - 2.0 * v.dot(normal) * normal;
}

}  // namespace

Field LinearField(const Vector3d& direction, const Vector3d& axis, double power) {
  const Vector3d across = Across(axis, direction);
  if (across.isZero()) throw std::invalid_argument("polarisation: the axis lies along the ray");
  return std::sqrt(power) * across.cast<std::complex<double>>();
}

Field OnMirror(const Field& field, const Vector3d& normal) {
  return 2.0 * Along(field, normal) * normal.cast<std::complex<double>>() - field;
}

SplitFields OnSplitter(const PolarisingSplitter& splitter, const Field& field, const Vector3d& direction,
                       const Vector3d& normal) {
  const Vector3d s = SAxis(splitter, direction, normal), p = s.cross(direction);
  const Vector3d s_back = Mirrored(s, normal), p_back = s_back.cross(Mirrored(direction, normal));
  const std::complex<double> in_s = Along(field, s), in_p = Along(field, p);
  const auto sum = [&](double of_s, const Vector3d& s_axis, double of_p, const Vector3d& p_axis) -> Field {
    return std::sqrt(of_s) * in_s * s_axis.cast<std::complex<double>>() +
           std::sqrt(of_p) * in_p * p_axis.cast<std::complex<double>>();
  };
  return {sum(splitter.s_transmitted, s, 1.0 - splitter.p_reflected, p),
          sum(1.0 - splitter.s_transmitted, s_back, splitter.p_reflected, p_back)};
}

Field Retard(const WavePlate& plate, const Field& field, const Vector3d& direction) {
  const Vector3d fast = Across(plate.fast_axis, direction), slow = direction.cross(fast);
  const std::complex<double> advance = std::polar(1.0, -0.5 * plate.retardance_rad);
  return advance * Along(field, fast) * fast.cast<std::complex<double>>() +
         std::conj(advance) * Along(field, slow) * slow.cast<std::complex<double>>();
}

}  // namespace twinbench::optics
