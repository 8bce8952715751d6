#include "optics/ghosts.h"

#include <cmath>
#include <utility>

#include "optics/kernels.h"
#include "optics/rotary_scenes.h"

namespace twinbench::optics {
namespace {

enum class Kind { kGrating, kSilicon, kWindowFace };

struct Element {
  Kind kind;
  int detector;
};

/// One ray on its way.
struct Light {
  Ray ray;
  double power_W;
  int order = 0;
  int reflections = 0;
  bool first_grating = true;
  bool in_glass = false;
  Eigen::Vector3d in_air = Eigen::Vector3d::Zero();  // direction before the last window
};

class Tracer {
 public:
  Tracer(const GhostBench& bench, const GhostOptions& options, double power_W)
      : bench_(bench), options_(options), floor_W_(options.threshold * power_W) {
    Add(RectangularPlane(SurfacePoseOfGrating(bench.X_LG), bench.grating->width_m, bench.grating->height_m),
        {Kind::kGrating, -1});
    for (int i = 0; i < 2; ++i) AddDetector(i);
  }

  /// All that becomes of a ray: way by way, or, where Embree is asked, the rays of a generation together.
  void Trace(const Light& light) {
    Follow(light);
    while (!waiting_.empty()) TraceGeneration();
  }

  std::vector<Deposit> Take() { return std::move(deposits_); }

 private:
  static constexpr double kOffSurface_m = 1e-6;

  void Follow(const Light& light) {
    if (!(light.power_W > floor_W_) || light.reflections > options_.max_reflections) return;
    if (bench_.scenes) return waiting_.push_back(light);
    const NearestHit nearest = Nearest(frames_, light.ray, kOffSurface_m);
    if (nearest.index == kNothing) return;
    if (bench_.blocked) {
      const Surface& met = surfaces_[static_cast<std::size_t>(nearest.index)];
      if (bench_.blocked(light.ray.origin_m, Point(met, nearest.hit.x_m, nearest.hit.y_m))) return;
    }
    At(light, nearest);
  }

  void TraceGeneration() {
    const std::vector<Light> generation = std::exchange(waiting_, {});
    RayBatch rays;
    for (const Light& light : generation) rays.Add(light.ray);
    const Eigen::Isometry3d X_GL = bench_.X_LG.inverse();
    RotaryScenes::Hits hits;
    bench_.scenes->First({&X_GL, 1}, rays, Meets::kEverything, hits);
    for (std::size_t i = 0; i < generation.size(); ++i) {
      const RotaryHit& met = hits.first[i];
      const RotaryElement element = met.element;
      if (element == RotaryElement::kDark || element == RotaryElement::kObstacle) continue;
      // The grating is the first of the surfaces here; the laboratory's follow in their order.
      At(generation[i], {element == RotaryElement::kGrating ? 0 : 1 + met.surface, met.hit});
    }
  }

  void At(const Light& light, const NearestHit& nearest) {
    const auto index = static_cast<std::size_t>(nearest.index);
    const Eigen::Vector3d point = Point(surfaces_[index], nearest.hit.x_m, nearest.hit.y_m);
    const Eigen::Vector3d normal = surfaces_[index].X_WS.linear().col(2);
    const bool from_front = light.ray.direction.dot(normal) < 0.0;
    if (elements_[index].kind == Kind::kWindowFace)
      return AtWindow(light, elements_[index].detector, point, normal);
    if (!from_front) return;
    if (elements_[index].kind == Kind::kGrating) return AtGrating(light, point, normal);
    AtSilicon(light, elements_[index].detector, nearest.hit, point, normal);
  }

  void Add(const Surface& surface, Element element) {
    surfaces_.push_back(surface);
    frames_.push_back(MakeFrame(surface));
    elements_.push_back(element);
  }

  void AddDetector(int i) {
    const auto n = static_cast<std::size_t>(i);
    const PsdParameters& psd = *bench_.psd[n];
    const double margin = 2.0 * kPackageMargin_m;
    Add(RectangularPlane(bench_.X_LP[n], psd.width_m + margin, psd.height_m + margin), {Kind::kSilicon, i});
    if (!psd.window) return;
    const auto faces = WindowFaces(*psd.window, bench_.X_LP[n], psd.width_m, psd.height_m);
    Add(faces.first, {Kind::kWindowFace, i});
    Add(faces.second, {Kind::kWindowFace, i});
  }

  void AtGrating(const Light& light, const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d across = bench_.X_LG.linear().col(0);
    const Eigen::Vector3d d_G = bench_.X_LG.linear().transpose() * light.ray.direction;
    const OrderEfficiencies orders = EfficienciesAt(*bench_.grating, bench_.wavelength_m, d_G);
    for (std::size_t i = 0; i < orders.share.size(); ++i) {
      const int m = orders.lowest_order + static_cast<int>(i);
      const OrderDirection out =
          Diffract(light.ray.direction, normal, across, m * bench_.wavelength_m * bench_.grating->lines_per_m);
      if (out.status != OrderStatus::kOk) continue;
      Light next = light;
      next.ray = {point, out.direction};
      next.power_W *= orders.share[i];
      next.order = light.first_grating ? m : light.order;
      next.first_grating = false;
      Follow(next);
    }
  }

  void AtSilicon(const Light& light, int detector, const SurfaceHit& hit, const Eigen::Vector3d& point,
                 const Eigen::Vector3d& normal) {
    const PsdParameters& psd = *bench_.psd[static_cast<std::size_t>(detector)];
    const Eigen::Matrix3d& r = bench_.X_LP[static_cast<std::size_t>(detector)].linear();
    const Eigen::Vector3d in_air = psd.window ? light.in_air : light.ray.direction;
    deposits_.push_back({.detector = detector,
                         .u_m = hit.x_m,
                         .v_m = hit.y_m,
                         .power_W = light.power_W * (1.0 - psd.silicon_reflectance),
                         .order = light.order,
                         .reflections = light.reflections,
                         .direction_P = r.transpose() * in_air});
    const bool active = 2.0 * std::abs(hit.x_m) <= psd.width_m && 2.0 * std::abs(hit.y_m) <= psd.height_m;
    if (active) FollowReflection(light, point, normal, psd.silicon_reflectance);
  }

  void FollowReflection(const Light& light, const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                        double reflectance) {
    Light next = light;
    next.ray = {point, Reflect(light.ray.direction, normal)};
    next.power_W *= reflectance;
    ++next.reflections;
    Follow(next);
  }

  void AtWindow(const Light& light, int detector, const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
    const Window& window = *bench_.psd[static_cast<std::size_t>(detector)]->window;
    const double ratio = light.in_glass ? window.index : 1.0 / window.index;
    const Refracted out = Refract(light.ray.direction, normal, ratio);
    if (out.total_reflection) return FollowReflection(light, point, normal, 1.0);
    Light next = light;
    next.ray = {point, out.direction};
    next.power_W *= 1.0 - window.reflectance;
    next.in_glass = !light.in_glass;
    if (!light.in_glass) next.in_air = light.ray.direction;
    Follow(next);
    if (!(window.coherent && light.in_glass)) FollowReflection(light, point, normal, window.reflectance);
  }

  const GhostBench& bench_;
  const GhostOptions& options_;
  double floor_W_;
  std::vector<Surface> surfaces_;
  std::vector<Frame> frames_;  // of the surfaces
  std::vector<Element> elements_;
  std::vector<Light> waiting_;
  std::vector<Deposit> deposits_;
};

}  // namespace

std::vector<Deposit> TraceGhosts(const GhostBench& bench, const Ray& chief, double power_W,
                                 const GhostOptions& options) {
  Tracer tracer(bench, options, power_W);
  tracer.Trace({.ray = chief, .power_W = power_W});
  return tracer.Take();
}

}  // namespace twinbench::optics
