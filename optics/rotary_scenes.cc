#include "optics/rotary_scenes.h"

namespace twinbench::optics {
namespace {

NearestHit NearestOf(const HitBatch& hits, std::size_t i) {
  return {hits.surface[i], {hits.t_m[i], hits.x_m[i], hits.y_m[i]}};
}

void Turn(std::span<const Eigen::Isometry3d> X_GL, const RayBatch& rays, RayBatch& turned) {
  turned.Resize(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Isometry3d& X = X_GL[X_GL.size() == 1 ? 0 : i];
    const Ray ray = rays.At(i);
    turned.Set(i, {X * ray.origin_m, X.linear() * ray.direction});
  }
}

}  // namespace

RotaryScenes::RotaryScenes(const RotaryOpticsParameters& parameters, const std::array<Eigen::Isometry3d, 2>& X_LP)
    : laboratory_(Scene::OnDeviceOf(riding_)) {
  riding_.AddSurface(RectangularPlane(SurfacePoseOfGrating(Eigen::Isometry3d::Identity()),
                                      parameters.grating.width_m, parameters.grating.height_m));
  for (int i = 0; i < 2; ++i) AddDetector(parameters.psd(i), X_LP[static_cast<std::size_t>(i)], i);
  for (const Blocker& blocker : parameters.blockers) {
    (blocker.rides_on_grating ? riding_ : laboratory_).AddMesh(blocker.mesh, blocker.pose);
    rides_ |= blocker.rides_on_grating;
  }
  riding_.Commit();
  laboratory_.Commit();
}

void RotaryScenes::AddDetector(const PsdParameters& psd, const Eigen::Isometry3d& X_LP, int i) {
  const double rim_m = 2.0 * kPackageMargin_m;
  laboratory_.AddSurface(RectangularPlane(X_LP, psd.width_m + rim_m, psd.height_m + rim_m));
  parts_.push_back({RotaryElement::kSilicon, i});
  if (!psd.window) return;
  const auto [back, front] = WindowFaces(*psd.window, X_LP, psd.width_m, psd.height_m);
  for (const Surface& face : {back, front}) {
    laboratory_.AddSurface(face);
    parts_.push_back({RotaryElement::kWindowFace, i});
  }
}

RotaryHit RotaryScenes::OnGrating(const NearestHit& met) const {
  if (met.index == kNothing) return {};
  return {met.index == kFixture ? RotaryElement::kObstacle : RotaryElement::kGrating, -1, -1, met.hit};
}

RotaryHit RotaryScenes::InLaboratory(const NearestHit& met) const {
  if (met.index == kNothing) return {};
  if (met.index == kFixture) return {RotaryElement::kObstacle, -1, -1, met.hit};
  const Part& part = parts_[static_cast<std::size_t>(met.index)];
  return {part.element, part.detector, met.index, met.hit};
}

RotaryHit RotaryScenes::First(const Eigen::Isometry3d& X_GL, const Ray& ray, Meets meets) const {
  const RotaryHit there = InLaboratory(laboratory_.First(ray));
  if (meets == Meets::kLaboratory) return there;
  const RotaryHit on_grating = OnGrating(riding_.First({X_GL * ray.origin_m, X_GL.linear() * ray.direction}));
  return on_grating.hit.t_m < there.hit.t_m ? on_grating : there;
}

void RotaryScenes::First(std::span<const Eigen::Isometry3d> X_GL, const RayBatch& rays, Meets meets,
                         Hits& hits) const {
  hits.first.resize(rays.size());
  laboratory_.Intersect(rays, hits.met);
  for (std::size_t i = 0; i < rays.size(); ++i) hits.first[i] = InLaboratory(NearestOf(hits.met, i));
  if (meets == Meets::kLaboratory) return;
  Turn(X_GL, rays, hits.turned);
  riding_.Intersect(hits.turned, hits.met);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RotaryHit on_grating = OnGrating(NearestOf(hits.met, i));
    if (on_grating.hit.t_m < hits.first[i].hit.t_m) hits.first[i] = on_grating;
  }
}

}  // namespace twinbench::optics
