#include "twin/diagnose/rotary/optical_bench.h"

#include <Eigen/Geometry>
#include <cmath>

#include "twin/measure/grating_model.h"

namespace twinbench::diagnose::rotary {
namespace {

/// A straight line of light.
struct Ray {
  Vector3 from, along;
};

Ray LaserRay(const OpticalBench& bench) {
  const Eigen::AngleAxisd aside(-bench.incidence_rad, Vector3::UnitZ());
  const Eigen::AngleAxisd yaw(bench.laser_yaw_rad, Vector3::UnitZ());
  // Upwards is a negative turn about x for light that runs along -y.
  const Eigen::AngleAxisd pitch(-bench.laser_pitch_rad, Vector3::UnitX());
  return {aside * Vector3(0.0, bench.laser_distance_m, 0.0), aside * (yaw * (pitch * Vector3(0.0, -1.0, 0.0)))};
}

/// Conical diffraction: the component of the wave vector along the grating grows by m lambda rho across the
/// grooves.
Vector3 Diffract(const Vector3& incident, const Matrix3& rotation_LG, double order_sine) {
  const Vector3 normal = rotation_LG.col(1);
  const Vector3 along = incident - incident.dot(normal) * normal + order_sine * rotation_LG.col(0);
  return along + std::sqrt(1.0 - along.squaredNorm()) * normal;  // NaN when evanescent
}

/// Place on one PSD (side +1: A, -1: B) in its own u and v.
Eigen::Vector2d MeetPsd(const Ray& ray, double side, double distance_m, double sin_theta) {
  const double cos_theta = std::sqrt(1.0 - sin_theta * sin_theta);
  const Vector3 nominal(side * sin_theta, cos_theta, 0.0), u_axis(cos_theta, -side * sin_theta, 0.0);
  const Vector3 hit = ray.from + (distance_m - ray.from.dot(nominal)) / ray.along.dot(nominal) * ray.along;
  return {hit.dot(u_axis), hit.z()};
}

Vector4 TraceSpots(const OpticalBench& bench, const Vector4& motion) {
  const Matrix3 rotation_LG = measure::MotionRotation(motion);
  const Ray laser = LaserRay(bench);
  const Vector3 on_grating(0.0, motion[3], 0.0), normal = rotation_LG.col(1);
  const Vector3 spot = laser.from + (on_grating - laser.from).dot(normal) / laser.along.dot(normal) * laser.along;
  const double sine = (bench.nominal.wavelength_m + bench.wavelength_error_m) * bench.nominal.lines_per_m;
  Vector4 spots_m;
  for (int p = 0; p < 2; ++p) {
    const auto at = static_cast<std::size_t>(p);
    const double side = p == 0 ? 1.0 : -1.0;
    const Ray order{spot, Diffract(laser.along, rotation_LG, side * sine)};
    const double distance_m = bench.nominal.psd_distance_m[at] + bench.distance_error_m[at];
    spots_m.segment<2>(2 * p) = MeetPsd(order, side, distance_m, bench.nominal.SinTheta());
  }
  return spots_m;
}

/// Equations 1-12 as printed, solved for the spots; their x, z and normal point against ours.
Vector4 PublishedSpots(const OpticalBench& bench, const Vector4& motion) {
  const double sine = bench.nominal.SinTheta(), cosine = std::sqrt(1.0 - sine * sine);
  const double ez_p = -motion[0], ex_p = motion[1], ey_p = -motion[2], dy_p_m = -motion[3];
  const double lever_m = bench.nominal.SpotFromTarget().z() * std::sin(ey_p) * std::tan(ey_p);
  Vector4 spots_m;
  for (int p = 0; p < 2; ++p) {
    const double side = p == 0 ? 1.0 : -1.0, l1_m = bench.nominal.psd_distance_m[static_cast<std::size_t>(p)];
    const double second_order_m = l1_m * sine * (1.0 - std::cos(2.0 * ez_p));
    spots_m[2 * p] = l1_m * cosine * std::sin(2.0 * ez_p) - side * (second_order_m - dy_p_m * sine / cosine);
    spots_m[2 * p + 1] = l1_m * std::tan(2.0 * ex_p) + lever_m + side * l1_m * sine * std::tan(ey_p);
  }
  return spots_m;
}

/// The PSD and its amplifier: pincushion, stray light, roll, gain.
Eigen::Vector2d Detect(const OpticalBench& bench, int p, const Eigen::Vector2d& spot_m) {
  const auto at = static_cast<std::size_t>(p);
  const Eigen::Vector2d own = Eigen::Rotation2Dd(-bench.roll_rad[at]) * spot_m;
  const double pulled = (1.0 + bench.cubic_per_m2[at] * own.squaredNorm()) / (1.0 + bench.stray_fraction[at]);
  return {own.x() * pulled * (1.0 + bench.gain_error[2 * at]),
          own.y() * pulled * (1.0 + bench.gain_error[2 * at + 1])};
}

}  // namespace

OpticalBench BelievedBench(const Scenario& scenario) {
  OpticalBench bench;
  bench.nominal = measure::NominalGeometry(scenario);
  bench.laser_distance_m = scenario.laser.position_m.y();
  bench.laser_yaw_rad = scenario.laser.yaw_rad;
  bench.laser_pitch_rad = scenario.laser.pitch_rad;
  bench.roll_rad = {scenario.psd_a.roll_rad, scenario.psd_b.roll_rad};
  bench.cubic_per_m2 = {scenario.psd_a.cubic_per_m2, scenario.psd_b.cubic_per_m2};
  bench.stray_fraction = {scenario.psd_a.stray_fraction, scenario.psd_b.stray_fraction};
  bench.gain_error = scenario.amplifier.gain_error;
  return bench;
}

Vector4 ShownSpots(const OpticalBench& bench, const Vector4& motion) {
  const Vector4 spots_m = bench.published ? PublishedSpots(bench, motion) : TraceSpots(bench, motion);
  Vector4 shown_m;
  for (int p = 0; p < 2; ++p) shown_m.segment<2>(2 * p) = Detect(bench, p, spots_m.segment<2>(2 * p));
  return shown_m;
}

Vector4 ShownByWavelength(const OpticalBench& bench) {
  constexpr double kStep_m = 0.01 * units::nm;
  OpticalBench longer = bench, shorter = bench;
  longer.wavelength_error_m += kStep_m;
  shorter.wavelength_error_m -= kStep_m;
  return (ShownSpots(longer, Vector4::Zero()) - ShownSpots(shorter, Vector4::Zero())) / (2.0 * kStep_m);
}

Eigen::Matrix4d ShownJacobian(const OpticalBench& bench, const Vector4& motion) {
  constexpr double kStep = 1e-5;
  Eigen::Matrix4d jacobian;
  for (int i = 0; i < 4; ++i) {
    const Vector4 step = kStep * Vector4::Unit(i);
    jacobian.col(i) = (ShownSpots(bench, motion + step) - ShownSpots(bench, motion - step)) / (2.0 * kStep);
  }
  return jacobian;
}

}  // namespace twinbench::diagnose::rotary
