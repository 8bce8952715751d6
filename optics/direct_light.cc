#include "optics/direct_light.h"

namespace twinbench::optics {

GratingPoses::GratingPoses(std::span<const Eigen::Isometry3d> poses) : X_LG(poses) {
  X_GL.reserve(poses.size());
  for (const Eigen::Isometry3d& X : poses) X_GL.push_back(X.inverse());
}

DirectLight::DirectLight(const RotaryOpticsParameters& parameters, const std::array<Eigen::Isometry3d, 2>& X_LP)
    : scenes_(parameters, X_LP),
      lines_per_m_(parameters.grating.lines_per_m),
      form_(parameters.grating.form),
      window_{parameters.psd_a.window, parameters.psd_b.window} {
  for (int i = 0; i < 2; ++i) {
    const auto n = static_cast<std::size_t>(i);
    plane_[n] = MakeFrame(RectangularPlane(X_LP[n], parameters.psd(i).width_m, parameters.psd(i).height_m));
  }
}

/// From the grating's front into the detector's order.
bool DirectLight::Leave(const Eigen::Isometry3d& X_LG, const Ray& ray, const RotaryHit& hit, double wavelength_m,
                        int i, Way& way) const {
  const Eigen::Vector3d normal = X_LG.linear().col(1);
  if (hit.element != RotaryElement::kGrating || !(ray.direction.dot(normal) < 0.0)) return false;
  const double shift = kOrderOfPsd[static_cast<std::size_t>(i)] * wavelength_m * lines_per_m_;
  LocalGrating local{normal, X_LG.linear().col(0)};
  // y of the surface runs along the grooves backwards (SurfacePoseOfGrating).
  if (form_) local = LocalGratingAt(*form_, local.across, normal, X_LG.linear().col(2), hit.hit.x_m, -hit.hit.y_m);
  const OrderDirection out = Diffract(ray.direction, local.normal, local.across, shift);
  way.ray = {X_LG * Eigen::Vector3d(hit.hit.x_m, 0.0, -hit.hit.y_m), out.direction};
  return out.status == OrderStatus::kOk;
}

void DirectLight::Land(double u_m, double v_m, Way& way) {
  way.landing.arrives = true;
  way.landing.u_m = u_m;
  way.landing.v_m = v_m;
  if (way.behind_window) return;
  way.landing.in_air_m = {u_m, v_m};
  way.landing.direction = way.ray.direction;
}

/// Through a face of the detector's window.
bool DirectLight::Refract(const RotaryHit& hit, int i, Way& way) const {
  const auto n = static_cast<std::size_t>(i);
  const Surface& face = scenes_.surface(hit.surface);
  if (!way.behind_window) {
    const Eigen::Vector3d &o = way.ray.origin_m, &d = way.ray.direction;
    double t;
    MeetPlane(plane_[n], o.x(), o.y(), o.z(), d.x(), d.y(), d.z(), t, way.landing.in_air_m.x(),
              way.landing.in_air_m.y());
    way.landing.direction = d;
    way.behind_window = true;
  }
  const double ratio = way.in_glass ? window_[n]->index : 1.0 / window_[n]->index;
  const Refracted out = optics::Refract(way.ray.direction, face.X_WS.linear().col(2), ratio);
  way.ray = {Point(face, hit.hit.x_m, hit.hit.y_m), out.direction};
  way.landing.transmission *= 1.0 - window_[n]->reflectance;
  way.in_glass = !way.in_glass;
  return !out.total_reflection;
}

/// @return whether the light goes on.
bool DirectLight::Advance(const RotaryHit& hit, int i, Way& way) const {
  const Frame& plane = plane_[static_cast<std::size_t>(i)];
  const Eigen::Vector3d &o = way.ray.origin_m, &d = way.ray.direction;
  if (hit.element == RotaryElement::kDark && !way.in_glass) {
    double t, u_m, v_m;
    MeetPlane(plane, o.x(), o.y(), o.z(), d.x(), d.y(), d.z(), t, u_m, v_m);
    if (t > 0.0) Land(u_m, v_m, way);
    return false;
  }
  if (hit.detector != i) return false;
  if (hit.element == RotaryElement::kWindowFace) return Refract(hit, i, way);
  if (d.dot(Eigen::Vector3d(plane.zx, plane.zy, plane.zz)) < 0.0) Land(hit.hit.x_m, hit.hit.y_m, way);
  return false;
}

std::array<Landing, 2> DirectLight::Trace(const Eigen::Isometry3d& X_LG, const Ray& ray,
                                          double wavelength_m) const {
  const Eigen::Isometry3d X_GL = X_LG.inverse();
  const RotaryHit on_grating = scenes_.First(X_GL, ray);
  std::array<Landing, 2> landings;
  for (int i = 0; i < 2; ++i) {
    Way way;
    bool goes_on = Leave(X_LG, ray, on_grating, wavelength_m, i, way);
    while (goes_on) goes_on = Advance(scenes_.First(X_GL, way.ray, scenes_.behind_grating()), i, way);
    landings[static_cast<std::size_t>(i)] = way.landing;
  }
  return landings;
}

/// From the grating into one order.
void DirectLight::LeaveAll(const GratingPoses& poses, const RayBatch& rays, std::span<const double> wavelength_m,
                           int i, Landings& landings) const {
  landings.ways.resize(rays.size());
  std::size_t leaving = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const std::size_t p = poses.Of(k);
    Way& way = landings.ways[leaving];
    way = {};
    way.index = static_cast<std::uint32_t>(k);
    leaving += Leave(poses.X_LG[p], rays.At(k), landings.on_grating.first[k], wavelength_m[p], i, way) ? 1 : 0;
  }
  landings.ways.resize(leaving);
}

/// All ways of one order, each step of them together.
void DirectLight::FollowAll(const GratingPoses& poses, int i, Landings& landings) const {
  std::vector<Way>& ways = landings.ways;
  std::span<const Eigen::Isometry3d> X_GL = poses.X_GL;
  while (!ways.empty()) {
    landings.rays.Resize(ways.size());
    for (std::size_t k = 0; k < ways.size(); ++k) landings.rays.Set(k, ways[k].ray);
    if (poses.X_LG.size() > 1) {
      landings.X_GL.clear();
      for (const Way& way : ways) landings.X_GL.push_back(poses.X_GL[way.index]);
      X_GL = landings.X_GL;
    }
    scenes_.First(X_GL, landings.rays, scenes_.behind_grating(), landings.hits);
    std::size_t left = 0;
    for (std::size_t k = 0; k < ways.size(); ++k) {
      const bool goes_on = Advance(landings.hits.first[k], i, ways[k]);
      landings.on[static_cast<std::size_t>(i)][ways[k].index] = ways[k].landing;
      if (goes_on) ways[left++] = ways[k];
    }
    ways.resize(left);
  }
}

void DirectLight::Trace(const GratingPoses& poses, const RayBatch& rays, std::span<const double> wavelength_m,
                        Landings& landings) const {
  scenes_.First(poses.X_GL, rays, Meets::kEverything, landings.on_grating);
  for (int i = 0; i < 2; ++i) {
    landings.on[static_cast<std::size_t>(i)].assign(rays.size(), {});
    LeaveAll(poses, rays, wavelength_m, i, landings);
    FollowAll(poses, i, landings);
  }
}

}  // namespace twinbench::optics
