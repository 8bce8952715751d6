#pragma once

#include <variant>
#include <vector>

#include "optics/polarisation.h"
#include "optics/scene.h"

/// An instrument as surfaces that stand still, each with what it does to light: Embree finds the next one.
namespace twinbench::optics {

/// Light ends here: a detector, a dump, a housing.
struct Sink {};

/// Ideal: every ray through a point of an object plane goes through one point of the image plane.
struct ThinLens {
  double focal_length_m = 0.0;  // negative: diverging
};

/// Two media: `index_front` on the side of the surface's +z. Two of them are a lens as it is made. Fresnel's losses
/// are not modelled; light that is totally reflected stays in its medium.
struct Interface {
  double index_front = 1.0, index_behind = 1.0;
};

/// A retarder with two faces, one on +z of its surface, in one place; each reflects a share of the power. Light
/// that both reflect in turn, the product of the shares, is lost.
struct CoatedPlate {
  WavePlate plate;
  double front_reflected = 0.0, back_reflected = 0.0;
};

using OpticalElement = std::variant<Sink, ThinLens, Interface, CoatedPlate, PolarisingSplitter>;

/// Light on its way through an instrument.
struct PolarisedLight {
  Ray ray;
  Field field = Field::Zero();
  int returns = 0;  // how often it came back from outside: kept for whoever sends it in again

  double power() const { return field.squaredNorm(); }
};

/// Light that a sink has taken.
struct Arrival {
  int element = kNothing;
  double x_m = 0.0, y_m = 0.0;  // in the surface's frame
  double power = 0.0;
  int returns = 0;
};

struct Followed {
  std::vector<Arrival> arrivals;
  std::vector<PolarisedLight> leaving;  // met nothing any more
};

/// One step of a way that many rays go together: light that is split goes one way only.
struct WayStep {
  int element = kNothing;
  bool is_reflected = false;  // at a splitter; else through
};

/// Static: once committed nothing changes. Const members may run in several threads.
class ElementScene {
 public:
  /// @return Index of the element. @throws std::invalid_argument from Validate(surface), or naming a share that is
  ///         not from 0 to 1, a focal length of 0, an index that is not positive.
  int Add(const Surface& surface, const OpticalElement& element);
  void Commit() { scene_.Commit(); }

  /// Follows light through every split until it has ended in sinks or leaves; what is weaker than `threshold` is
  /// dropped. Powers add: light that meets again does not interfere.
  /// @throws std::runtime_error if the light goes to and fro without end.
  void Follow(const PolarisedLight& light, double threshold, Followed& followed) const;

  /// Takes many rays one way, in packets: geometry without power. Rays end at the last element of the way, where
  /// `hits` says where; a ray that meets another element first has kNothing there and stays out of the rest.
  void FollowWay(const std::vector<WayStep>& way, RayBatch& rays, HitBatch& hits) const;

  const Scene& scene() const { return scene_; }

 private:
  Scene scene_;
  std::vector<OpticalElement> elements_;
};

/// Direction behind an ideal lens of light that meets it at (x, y) of its surface.
Eigen::Vector3d ThroughLens(const ThinLens& lens, const Surface& surface, double x_m, double y_m,
                            const Eigen::Vector3d& direction);

}  // namespace twinbench::optics
