#include "optics/closed_light.h"

#include <algorithm>

namespace twinbench::optics {
namespace {

std::optional<Scene> BlockerScene(const std::vector<Blocker>& blockers, bool riding) {
  if (std::ranges::none_of(blockers, [riding](const Blocker& b) { return b.rides_on_grating == riding; }))
    return std::nullopt;
  Scene scene;
  for (const Blocker& blocker : blockers) {
    if (blocker.rides_on_grating == riding) scene.AddMesh(blocker.mesh, blocker.pose);
  }
  scene.Commit();
  return scene;
}

}  // namespace

ClosedLight::ClosedLight(const RotaryOpticsParameters& parameters, const std::array<Eigen::Isometry3d, 2>& X_LP)
    : lines_per_m_(parameters.grating.lines_per_m),
      form_(parameters.grating.form),
      fixed_blockers_(BlockerScene(parameters.blockers, false)),
      riding_blockers_(BlockerScene(parameters.blockers, true)) {
  for (int i = 0; i < 2; ++i) {
    const auto n = static_cast<std::size_t>(i);
    planes_[n] = MakeFrame(RectangularPlane(X_LP[n], parameters.psd(i).width_m, parameters.psd(i).height_m));
  }
}

/// y of the surface runs along the grooves backwards (SurfacePoseOfGrating).
LocalGrating ClosedLight::GratingAt(const Frame& g, double x_m, double y_m) const {
  const Eigen::Vector3d across(g.xx, g.xy, g.xz), normal(g.zx, g.zy, g.zz), along(-g.yx, -g.yy, -g.yz);
  return form_ ? LocalGratingAt(*form_, across, normal, along, x_m, -y_m) : LocalGrating{normal, across};
}

ClosedLight::Way ClosedLight::Follow(const Frame& g, const Ray& ray, double wavelength_m, int i) const {
  Way way;
  const auto& o = ray.origin_m;
  const auto& d = ray.direction;
  double t, x, y;
  MeetPlane(g, o.x(), o.y(), o.z(), d.x(), d.y(), d.z(), t, x, y);
  const Eigen::Vector3d normal(g.zx, g.zy, g.zz);
  if (!(t > 0.0) || !InAperture(g, x, y) || !(d.dot(normal) < 0.0)) return way;
  const auto n = static_cast<std::size_t>(i);
  const double shift = kOrderOfPsd[n] * wavelength_m * lines_per_m_;
  const LocalGrating local = GratingAt(g, x, y);
  const OrderDirection out = Diffract(d, local.normal, local.across, shift);
  if (out.status != OrderStatus::kOk) return way;
  const Eigen::Vector3d p = o + t * d;
  MeetPlane(planes_[n], p.x(), p.y(), p.z(), out.direction.x(), out.direction.y(), out.direction.z(), t, x, y);
  if (!(t > 0.0)) return way;
  way.landing = {true, x, y, 1.0, {x, y}, out.direction};
  way.on_grating_m = p;
  way.onwards_m = t;
  return way;
}

bool ClosedLight::Blocked(const Eigen::Isometry3d& X_LG, const Eigen::Vector3d& from_m,
                          const Eigen::Vector3d& to_m) const {
  if (fixed_blockers_ && fixed_blockers_->Occluded(from_m, to_m)) return true;
  if (!riding_blockers_) return false;
  const Eigen::Isometry3d X_GL = X_LG.inverse();
  return riding_blockers_->Occluded(X_GL * from_m, X_GL * to_m);
}

Landing ClosedLight::Trace(const Frame& grating, const Eigen::Isometry3d& X_LG, const Ray& ray, double wavelength_m,
                           int i) const {
  const Way way = Follow(grating, ray, wavelength_m, i);
  if (!way.landing.arrives) return {};
  const Eigen::Vector3d on_plane_m = way.on_grating_m + way.onwards_m * way.landing.direction;
  const bool blocked = Blocked(X_LG, ray.origin_m, way.on_grating_m) || Blocked(X_LG, way.on_grating_m, on_plane_m);
  return blocked ? Landing{} : way.landing;
}

}  // namespace twinbench::optics
