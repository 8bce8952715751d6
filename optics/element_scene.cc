#include "optics/element_scene.h"

#include <cmath>
#include <complex>
#include <stdexcept>
#include <string>

#include "optics/window.h"

namespace twinbench::optics {
namespace {

using Eigen::Vector3d;

void Demand(bool good, const char* what) {
  if (!good) throw std::invalid_argument(std::string("optical element: ") + what);
}

bool IsShare(double value) {
  return value >= 0.0 && value <= 1.0;
}

struct Check {
  void operator()(const Sink&) const {}
  void operator()(const ThinLens& e) const {
    Demand(std::isfinite(e.focal_length_m) && e.focal_length_m != 0.0, "the focal length must be finite, not 0");
  }
  void operator()(const Interface& e) const {
    Demand(e.index_front > 0.0 && e.index_behind > 0.0, "an index must be positive");
  }
  void operator()(const CoatedPlate& e) const {
    Demand(IsShare(e.front_reflected) && IsShare(e.back_reflected), "a reflected share must be from 0 to 1");
    Demand(std::isfinite(e.plate.retardance_rad), "the retardance must be finite");
  }
  void operator()(const PolarisingSplitter& e) const {
    Demand(IsShare(e.p_reflected) && IsShare(e.s_transmitted), "a share of the splitter must be from 0 to 1");
  }
};

/// A ray that has met an element.
struct Meeting {
  const Surface* surface;
  int element;
  double x_m, y_m;
  Vector3d direction;  // of the light that comes

  Vector3d normal() const { return Normal(*surface, x_m, y_m); }
  Vector3d point_m() const { return Point(*surface, x_m, y_m); }
};

Vector3d Through(const ThinLens& lens, const Meeting& at) {
  return ThroughLens(lens, *at.surface, at.x_m, at.y_m, at.direction);
}

Vector3d Through(const Interface& e, const Meeting& at) {
  const Vector3d normal = at.normal();
  const bool from_front = at.direction.dot(normal) < 0.0;
  const double before = from_front ? e.index_front : e.index_behind;
  return Refract(at.direction, normal, before / (from_front ? e.index_behind : e.index_front)).direction;
}

/// Across the new direction, with the power that it had.
Field Turned(const Field& field, const Vector3d& direction) {
  const std::complex<double> along =
      field.x() * direction.x() + field.y() * direction.y() + field.z() * direction.z();
  const Field across = field - along * direction.cast<std::complex<double>>();
  return across * (field.norm() / across.norm());
}

/// What becomes of light at an element: onwards, or taken.
struct Splitting {
  const PolarisedLight& light;
  const Meeting& at;
  std::vector<PolarisedLight>& onwards;
  Followed& followed;

  void Send(const Vector3d& direction, const Field& field) const {
    onwards.push_back({{at.point_m(), direction}, field, light.returns});
  }

  void operator()(const Sink&) const {
    followed.arrivals.push_back({at.element, at.x_m, at.y_m, light.power(), light.returns});
  }
  void operator()(const ThinLens& e) const {
    const Vector3d direction = Through(e, at);
    Send(direction, Turned(light.field, direction));
  }
  void operator()(const Interface& e) const {
    const Vector3d direction = Through(e, at);
    Send(direction, Turned(light.field, direction));
  }
  void operator()(const CoatedPlate& e) const {
    const Vector3d normal = at.normal(), back = Reflect(at.direction, normal);
    const bool from_front = at.direction.dot(normal) < 0.0;
    const double near = from_front ? e.front_reflected : e.back_reflected;
    const double far = from_front ? e.back_reflected : e.front_reflected;
    const Field within = std::sqrt(1.0 - near) * Retard(e.plate, light.field, at.direction);
    if (near > 0.0) Send(back, std::sqrt(near) * OnMirror(light.field, normal));
    if (far > 0.0) Send(back, std::sqrt((1.0 - near) * far) * Retard(e.plate, OnMirror(within, normal), back));
    Send(at.direction, std::sqrt(1.0 - far) * within);
  }
  void operator()(const PolarisingSplitter& e) const {
    const Vector3d normal = at.normal();
    const SplitFields fields = OnSplitter(e, light.field, at.direction, normal);
    Send(at.direction, fields.transmitted);
    Send(Reflect(at.direction, normal), fields.reflected);
  }
};

/// Where light goes that takes one way only.
struct OneWay {
  const Meeting& at;
  bool is_reflected;

  Vector3d operator()(const Sink&) const { throw std::logic_error("optical element: a way goes on behind a sink"); }
  Vector3d operator()(const ThinLens& e) const { return Through(e, at); }
  Vector3d operator()(const Interface& e) const { return Through(e, at); }
  Vector3d operator()(const CoatedPlate&) const { return ThroughOrBack(); }
  Vector3d operator()(const PolarisingSplitter&) const { return ThroughOrBack(); }

  Vector3d ThroughOrBack() const { return is_reflected ? Reflect(at.direction, at.normal()) : at.direction; }
};

}  // namespace

Vector3d ThroughLens(const ThinLens& lens, const Surface& surface, double x_m, double y_m,
                     const Vector3d& direction) {
  const Vector3d d = surface.X_WS.linear().transpose() * direction;
  // The slope changes by -place / f; multiplied by |d_z|, so that light along the axis stays as it is.
  const double steep = std::abs(d.z()) / lens.focal_length_m;
  const Vector3d behind(d.x() - steep * x_m, d.y() - steep * y_m, d.z());
  return surface.X_WS.linear() * behind.normalized();
}

int ElementScene::Add(const Surface& surface, const OpticalElement& element) {
  std::visit(Check{}, element);
  elements_.push_back(element);
  return scene_.AddSurface(surface);
}

void ElementScene::Follow(const PolarisedLight& light, double threshold, Followed& followed) const {
  constexpr int kMostMeetings = 10000;
  std::vector<PolarisedLight> pending{light};
  RayBatch ray;
  ray.Add(light.ray);
  HitBatch hit;
  for (int meetings = 0; !pending.empty(); ++meetings) {
    if (meetings == kMostMeetings) throw std::runtime_error("optical elements: light goes to and fro without end");
    const PolarisedLight now = pending.back();
    pending.pop_back();
    if (!(now.power() >= threshold)) continue;
    ray.Set(0, now.ray);
    scene_.Intersect(ray, hit);
    const int element = hit.surface[0];
    if (element < 0) {
      followed.leaving.push_back(now);
      continue;
    }
    const auto which = static_cast<std::size_t>(element);
    const Meeting at{&scene_.surfaces()[which], element, hit.x_m[0], hit.y_m[0], now.ray.direction};
    std::visit(Splitting{now, at, pending, followed}, elements_[which]);
  }
}

void ElementScene::FollowWay(const std::vector<WayStep>& way, RayBatch& rays, HitBatch& hits) const {
  std::vector<bool> is_lost(rays.size(), false);
  for (std::size_t k = 0; k < way.size(); ++k) {
    const WayStep& step = way[k];
    const auto which = static_cast<std::size_t>(step.element);
    scene_.Intersect(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      is_lost[i] = is_lost[i] || hits.surface[i] != step.element;
      if (is_lost[i]) {
        hits.surface[i] = kNothing;
        continue;
      }
      const Meeting at{&scene_.surfaces()[which], step.element, hits.x_m[i], hits.y_m[i], rays.At(i).direction};
      if (k + 1 < way.size() || !std::holds_alternative<Sink>(elements_[which]))
        rays.Set(i, {at.point_m(), std::visit(OneWay{at, step.is_reflected}, elements_[which])});
    }
  }
}

}  // namespace twinbench::optics
