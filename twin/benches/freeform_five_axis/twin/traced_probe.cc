#include "twin/benches/freeform_five_axis/twin/traced_probe.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "optics/quadrant_detector.h"
#include "twin/core/errors.h"

namespace twinbench::sim {
namespace {

optics::SlopeProbeParameters HeadOf(const FreeformSettings& bench) {
  const ProbeOpticsSettings& s = bench.optics;
  return {.lens_m = bench.qpd.lens_m,
          .splitter = {s.splitter_p_reflected, s.splitter_s_transmitted,
                       s.splitter == "grid" ? Vector3(Vector3::UnitX()) : Vector3(Vector3::Zero())},
          .plate_retardance_error_rad = s.plate_retardance_rad,
          .plate_azimuth_error_rad = s.plate_azimuth_rad,
          .plate_reflected = s.plate_reflected,
          .plate_tilt_rad = {s.plate_tilt_x_rad, s.plate_tilt_y_rad},
          .beam_radius_m = s.beam_radius_m,
          .wavelength_m = s.wavelength_m};
}

optics::SlopeProbe MakeHead(const FreeformSettings& bench) {
  try {
    return optics::SlopeProbe(HeadOf(bench));
  } catch (const std::invalid_argument& error) {
    throw InputError("optics", error.what(), "a beam and a probe that go together");
  }
}

optics::FormedSurface CellOf(double vertex_radius_m) {
  return optics::FormedSurface(
      optics::Paraboloid(Pose::Identity(), 0.5 * vertex_radius_m, TracedProbe::Reach_m(vertex_radius_m)));
}

optics::RayBatch Carried(const optics::RayBatch& rays, const Pose& X) {
  optics::RayBatch carried = rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const optics::Ray ray = rays.At(i);
    carried.Set(i, {X * ray.origin_m, X.linear() * ray.direction});
  }
  return carried;
}

}  // namespace

TracedProbe::TracedProbe(const FreeformSettings& bench)
    : bench_(bench),
      head_(MakeHead(bench)),
      camera_({.object_m = bench.ccd.object_m, .image_m = bench.ccd.image_m, .alpha_rad = bench.ccd.alpha_rad}),
      paraboloids_{CellOf(bench.artefact.vertex_radius_m[0]), CellOf(bench.artefact.vertex_radius_m[1])} {}

double TracedProbe::Reach_m(double vertex_radius_m) {
  constexpr double kLargest_m = 0.5;  // beyond, Embree's float tells too little apart
  return std::min(vertex_radius_m, kLargest_m);
}

optics::ProbedSurface TracedProbe::SurfaceUnder(const ArtefactCell& cell, const Pose& X_FT, double height_m,
                                                const optics::HeightMap* form) const {
  const optics::FormedSurface& paraboloid = paraboloids_[(cell.i + cell.j) % 2 == 0 ? 0 : 1];
  const Eigen::Vector2d vertex_m(cell.i * bench_.artefact.pitch_m, cell.j * bench_.artefact.pitch_m);
  Pose X_ST = X_FT;  // S: the cell's own, at its vertex
  X_ST.translation() -= Vector3(vertex_m.x(), vertex_m.y(), height_m);
  return [&paraboloid, vertex_m, X_ST, form](const optics::RayBatch& rays, optics::SurfacePoints& points) {
    paraboloid.Meet(Carried(rays, X_ST), form, vertex_m, points);
    const Pose X_TS = X_ST.inverse();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!points.is_met[i]) continue;
      points.point_m[i] = X_TS * points.point_m[i];
      points.normal[i] = X_TS.linear() * points.normal[i];
    }
  };
}

optics::ProbeView TracedProbe::View(const ArtefactCell& cell, const Pose& X_FT, double height_m,
                                    const optics::HeightMap* form) const {
  return head_.Look(SurfaceUnder(cell, X_FT, height_m, form));
}

/// The spots as the detector has them, whole light 1.
std::vector<optics::Spot> TracedProbe::SpotsOf(const optics::ProbeView& view,
                                               const optics::ProbedSurface& surface) const {
  const bool is_beam = bench_.optics.spot == "beam";
  const optics::Spot beam = is_beam && view.is_met ? head_.BeamOnDetector(surface) : optics::Spot{};
  std::vector<optics::Spot> spots;
  for (const optics::ProbePatch& patch : view.patches) {
    optics::Spot& spot =
        spots.emplace_back(optics::Spot{.u_m = patch.u_m, .v_m = patch.v_m, .power_W = patch.power});
    const double stated_m = 0.5 * bench_.qpd.spot_radius_m;
    spot.cov_m2 = stated_m * stated_m * Eigen::Matrix2d::Identity();
    if (!is_beam) continue;
    if (patch.returns == 0) {  // what a plane face sends back has the beam's divergence alone
      const double flat_m = 0.5 * bench_.qpd.lens_m * head_.divergence_rad();
      spot.cov_m2 = flat_m * flat_m * Eigen::Matrix2d::Identity();
      continue;
    }
    spot.cov_m2 = beam.cov_m2;
    spot.power_W *= beam.power_W;
    if (patch.returns == 1) spot.u_m = beam.u_m, spot.v_m = beam.v_m;
  }
  return spots;
}

ProbeSignals TracedProbe::Show(const ArtefactCell& cell, const Pose& X_FT, double height_m,
                               const optics::HeightMap* form, const Eigen::Vector2d& spot_m) const {
  const optics::ProbedSurface surface = SurfaceUnder(cell, X_FT, height_m, form);
  const optics::ProbeView view = head_.Look(surface);
  ProbeSignals signals;
  signals.qpd_x_V = signals.qpd_y_V = signals.qpd_sum_V = 0.0;
  for (optics::Spot& spot : SpotsOf(view, surface)) {
    spot.u_m += spot_m.x();
    spot.v_m += spot_m.y();
    const optics::QuadrantPowers share = optics::OnQuadrants(spot, bench_.qpd.gap_m);
    signals.qpd_x_V += bench_.qpd.sum_V * share.RightMinusLeft();
    signals.qpd_y_V += bench_.qpd.sum_V * share.TopMinusBottom();
    signals.qpd_sum_V += bench_.qpd.sum_V * share.Sum();
  }
  if (view.is_met) signals.ccd_px = bench_.ccd.centre_px + camera_.Seen_m(view.spot_m) / bench_.ccd.pixel_m;
  return signals;
}

std::uint64_t TracedProbe::rays() const {
  std::uint64_t sum = head_.scene().rays_traced() + camera_.scene().rays_traced();
  for (const optics::FormedSurface& paraboloid : paraboloids_) sum += paraboloid.scene().rays_traced();
  return sum;
}

}  // namespace twinbench::sim
