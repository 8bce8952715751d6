#include "tests/foreign/grating_stand.h"

#include <cmath>

namespace twinbench::foreign {
namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

constexpr double kLines_m = 600e3;
constexpr double kNominalSine = 0.39;  // 650 nm at 600 lines/mm

Isometry3d Turned(double angle_rad) {
  return Isometry3d(Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ()));
}
Isometry3d Moved(double x_m, double y_m, double z_m) {
  return Isometry3d(Eigen::Translation3d(x_m, y_m, z_m));
}

struct Ray {
  Vector3d from, along;
};

Ray LaserRay(const Light& light) {
  const Vector3d from(0.0, 0.2, 0.0);
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(light.laser_yaw_rad, Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(light.laser_pitch_rad, Vector3d::UnitX()))
                                   .toRotationMatrix();
  return {from, turn * Vector3d(0.0, -1.0, 0.0)};
}

Vector3d Meet(const Ray& ray, const Vector3d& point, const Vector3d& normal) {
  return ray.from + ray.along * normal.dot(point - ray.from) / normal.dot(ray.along);
}

/// Order `m`: the tangential part gains m lambda / d along the dispersion, the normal part makes the length one.
Vector3d Diffracted(const Vector3d& in, const Eigen::Matrix3d& R_LG, double m, double wavelength_m) {
  const Vector3d across = R_LG.col(0), normal = R_LG.col(1);
  const Vector3d tangential = in - normal.dot(in) * normal + m * wavelength_m * kLines_m * across;
  return tangential + std::sqrt(1.0 - tangential.squaredNorm()) * normal;
}

/// Place on the detector at `side` = +1 (A) or -1 (B).
Eigen::Vector2d OnDetector(const Ray& ray, double side, double distance_m) {
  const double cosine = std::sqrt(1.0 - kNominalSine * kNominalSine);
  const Vector3d towards(side * kNominalSine, cosine, 0.0), u(cosine, -side * kNominalSine, 0.0);
  const Vector3d p = Meet(ray, distance_m * towards, towards) - distance_m * towards;
  return {p.dot(u), p.z()};
}

}  // namespace

Isometry3d PoseOf(const TableError& e) {
  Isometry3d pose = Moved(e.dx_m, e.dy_m, e.dz_m);
  pose.rotate(Eigen::AngleAxisd(e.ez_rad, Vector3d::UnitZ()) * Eigen::AngleAxisd(e.ey_rad, Vector3d::UnitY()) *
              Eigen::AngleAxisd(e.ex_rad, Vector3d::UnitX()));
  return pose;
}

Isometry3d GratingOn(const Stacking& s) {
  const double reseat_rad = s.is_reseated ? -s.shift_rad : 0.0, clamp_rad = s.is_reseated ? 0.0 : s.shift_rad;
  return Moved(0.0, -0.030, -0.130) * PoseOf(s.target) * Turned(s.target_rad) * Moved(0.0, 0.0, 0.080) *
         PoseOf(s.seat) * Turned(reseat_rad) * PoseOf(s.reference) * Turned(s.reference_rad) * Turned(-clamp_rad) *
         Moved(0.0, 0.030, 0.050);
}

Spots ShineOn(const Isometry3d& X_LG, const Light& light) {
  const Ray laser = LaserRay(light);
  const Vector3d spot = Meet(laser, X_LG.translation(), X_LG.linear().col(1));
  const auto order = [&](double m) {
    return Ray{spot, Diffracted(laser.along, X_LG.linear(), m, light.wavelength_m)};
  };
  const Eigen::Vector2d a = OnDetector(order(1.0), 1.0, light.distance_a_m);
  const Eigen::Vector2d b = OnDetector(order(-1.0), -1.0, light.distance_b_m);
  return {a.x(), a.y(), b.x(), b.y()};
}

}  // namespace twinbench::foreign
