#pragma once

#include <functional>

#include "optics/beam.h"
#include "optics/element_scene.h"
#include "optics/formed_surface.h"
#include "optics/psd.h"

/// A probe that reads the slope of a surface by what it reflects: laser, beam reducer, polarising splitter,
/// quarter- wave plate, the surface, and back through plate and splitter to a lens with a detector in its focus.
///
/// Frame T: the beam runs along -z, its origin is the nominal spot on the surface.
namespace twinbench::optics {

struct SlopeProbeParameters {
  double lens_m = 0.0;                                             // focal length before the detector
  PolarisingSplitter splitter{.wires = Eigen::Vector3d::UnitX()};  // p is T's y, which the laser sends
  double plate_retardance_error_rad = 0.0;                         // beyond a quarter wave
  double plate_azimuth_error_rad = 0.0;                            // of its fast axis, beyond 45 deg
  double plate_reflected = 0.0;                                    // share of the power, each face
  Eigen::Vector2d plate_tilt_rad = Eigen::Vector2d::Zero();        // about x and y
  double beam_radius_m = 0.1e-3;                                   // 1/e^2, of the waist that the reducer puts at T
  double wavelength_m = 650e-9;
};

/// Sizes of the probe [m].
struct SlopeProbeSizes {
  static constexpr double plate = 0.050;     // from T to the wave plate: the free way over the surface
  static constexpr double lens = 0.120;      // from T to the lens, by way of the splitter
  static constexpr double clear = 0.0125;    // radius of plate and lens
  static constexpr double detector = 0.020;  // side
};

/// Where rays, given in T, meet the surface that is probed; points and normals in T.
using ProbedSurface = std::function<void(const RayBatch& rays, SurfacePoints& points)>;

/// A patch of light on the detector; u, v as the light's slopes along x and y of T would have it.
struct ProbePatch {
  double u_m = 0.0, v_m = 0.0;
  double power = 0.0;  // of the laser's
  int returns = 0;     // meetings with the surface; 0: light that has never been there
};

struct ProbeView {
  bool is_met = false;  // by the laser's light
  Eigen::Vector3d spot_m = Eigen::Vector3d::Zero();
  std::vector<ProbePatch> patches;
};

/// Immutable after construction; const members may run in several threads. The lens is ideal: u = f r_x / r_z for a
/// reflection r, wherever it goes through. Thicknesses of plate and splitter are not modelled.
class SlopeProbe {
 public:
  /// @throws std::invalid_argument naming what is missing or out of range.
  explicit SlopeProbe(const SlopeProbeParameters& parameters);

  /// All ways of the chief ray, split wherever light is split, down to 1e-7 of the power; patches in no order.
  ProbeView Look(const ProbedSurface& surface) const;

  /// Mean and covariance on the detector of the whole beam on its main way, power 1 less what was lost on it.
  ///
  /// A Gaussian beam as 81 weighted rays, traced in packets; exact where the surface is of third order over the
  /// spot. The waist at T is what the reducer is set to.
  Spot BeamOnDetector(const ProbedSurface& surface) const;

  double divergence_rad() const;  // 1/e^2 half angle of the beam
  const Scene& scene() const { return elements_.scene(); }

 private:
  void Reflect(const PolarisedLight& light, const ProbedSurface& surface, std::vector<PolarisedLight>& onwards,
               ProbeView& view) const;
  void LaunchBeam();

  SlopeProbeParameters parameters_;
  ElementScene elements_;
  int outer_lens_ = kNothing, inner_lens_ = kNothing, splitter_ = kNothing, plate_ = kNothing, lens_ = kNothing,
      detector_ = kNothing;
  BeamNodes nodes_;
  RayBatch launched_;  // one ray for each node, at the laser
};

}  // namespace twinbench::optics
