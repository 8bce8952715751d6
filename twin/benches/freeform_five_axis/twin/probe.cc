#include "twin/benches/freeform_five_axis/twin/probe.h"

#include <cmath>

namespace twinbench::sim {
namespace {

/// Shares of a Gaussian spot on either side of a gap.
struct Sides {
  double above, below;
};

Sides SidesOf(double at_m, const QuadrantSettings& qpd) {
  const double scale = std::sqrt(2.0) / qpd.spot_radius_m;
  return {0.5 * std::erfc(scale * (0.5 * qpd.gap_m - at_m)), 0.5 * std::erfc(scale * (0.5 * qpd.gap_m + at_m))};
}

/// From the closed form to the surface with its form error: Newton's steps, each of which leaves some 1e-4 of the
/// height.
double OnForm_m(const Vector3& from, const Vector3& beam, double radius_m, const Vector3& vertex_F,
                const optics::HeightMap& form, double distance_m) {
  constexpr int kSteps = 4;
  for (int step = 0; step < kSteps; ++step) {
    const Vector3 p = from + distance_m * beam;
    const optics::HeightAt at = optics::Interpolate(form, vertex_F.x() + p.x(), vertex_F.y() + p.y());
    const double above_m = p.z() - p.head<2>().squaredNorm() / (2.0 * radius_m) - at.height_m;
    const Eigen::Vector2d slope = p.head<2>() / radius_m + at.slope;
    distance_m -= above_m / (beam.z() - slope.dot(beam.head<2>()));
  }
  return distance_m;
}

}  // namespace

ProbeSpot Look(const ArtefactSettings& artefact, const ArtefactCell& cell, const Pose& X_FT, double height_m,
               const optics::HeightMap* form) {
  const double radius_m = artefact.vertex_radius_m[(cell.i + cell.j) % 2 == 0 ? 0 : 1];
  const Vector3 vertex_F(cell.i * artefact.pitch_m, cell.j * artefact.pitch_m, height_m);
  const Vector3 p = X_FT.translation() - vertex_F;
  const Vector3 d = -X_FT.linear().col(2);
  // |x + t d_x, y + t d_y|^2 = 2 R (z + t d_z); of the two, the point that the beam meets going down into the bowl.
  const double a = d.head<2>().squaredNorm();
  const double b = p.head<2>().dot(d.head<2>()) - radius_m * d.z();
  const double c = p.head<2>().squaredNorm() - 2.0 * radius_m * p.z();
  ProbeSpot spot;
  spot.distance_m = -c / (b + std::sqrt(b * b - a * c));
  if (form) spot.distance_m = OnForm_m(p, d, radius_m, vertex_F, *form, spot.distance_m);
  spot.hit_F = p + spot.distance_m * d;
  Eigen::Vector2d slope = spot.hit_F.head<2>() / radius_m;
  if (form) slope += optics::Interpolate(*form, vertex_F.x() + spot.hit_F.x(), vertex_F.y() + spot.hit_F.y()).slope;
  const Vector3 normal = Vector3(-slope.x(), -slope.y(), 1.0).normalized();
  spot.reflected_T = X_FT.linear().transpose() * (d - 2.0 * d.dot(normal) * normal);
  return spot;
}

Eigen::Vector2d OnQuadrants_m(const QuadrantSettings& qpd, const ProbeSpot& spot) {
  return qpd.lens_m * spot.reflected_T.head<2>() / spot.reflected_T.z();
}

void ShowQuadrants(const QuadrantSettings& qpd, const Eigen::Vector2d& at_m, ProbeSignals& signals) {
  const Sides p = SidesOf(at_m.x(), qpd), q = SidesOf(at_m.y(), qpd);
  signals.qpd_x_V = qpd.sum_V * (p.above - p.below) * (q.above + q.below);
  signals.qpd_y_V = qpd.sum_V * (q.above - q.below) * (p.above + p.below);
  signals.qpd_sum_V = qpd.sum_V * (p.above + p.below) * (q.above + q.below);
}

double Camera_px(const CameraSettings& ccd, double distance_m) {
  const double alpha = ccd.alpha_rad;
  const double beta = std::atan(ccd.object_m * std::tan(alpha) / ccd.image_m);
  const double s_m = ccd.image_m * distance_m * std::sin(alpha) /
                     (ccd.object_m * std::sin(beta) + distance_m * std::sin(alpha + beta));
  return ccd.centre_px + s_m / ccd.pixel_m;
}

}  // namespace twinbench::sim
