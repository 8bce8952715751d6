#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "optics/beam.h"
#include "optics/ghosts.h"
#include "optics/kernels.h"
#include "optics/scene.h"

/// The optics of the rotary bench: one laser, one grating, detectors for the orders +1 (A) and -1 (B).
///
/// Frame L: x dispersion, y nominal grating normal (towards laser and detectors), z up; frame G: x across the
/// grooves, y normal, z along the grooves. The laser shines along -y_L.
namespace twinbench::optics {

/// The laser at one moment. Angles are the whole pointing error: yaw about z_L, then pitch upwards.
struct SourceState {
  double wavelength_m = std::numeric_limits<double>::quiet_NaN();  // in the air around
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double power_W = std::numeric_limits<double>::quiet_NaN();
};

struct BeamParameters {
  BeamKind kind = BeamKind::kChiefRay;
  double radius_m = std::numeric_limits<double>::quiet_NaN();  // 1/e^2 of the irradiance, at the laser
  double divergence_rad = 0.0;                                 // 1/e^2 half angle
  std::optional<IrradianceMap> profile;                        // for BeamKind::kProfile
};

/// Something opaque in the way: fixed in L, or riding on the grating with its pose given in G.
struct Blocker {
  TriangleMesh mesh;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  bool rides_on_grating = false;
};

struct RotaryOpticsParameters {
  double nominal_wavelength_m = std::numeric_limits<double>::quiet_NaN();  // the detectors are placed for it
  Eigen::Vector3d laser_position_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());  // in L
  Grating grating;
  PsdParameters psd_a;
  PsdParameters psd_b;
  BeamParameters beam;
  std::vector<Blocker> blockers;
  GhostOptions ghosts;
};

struct PsdSignals {
  PsdSignal a;
  PsdSignal b;
};

/// Immutable after construction; Trace may run in several threads.
class RotaryOptics {
 public:
  /// @throws std::invalid_argument naming the field that is missing or out of range, or an order +-1 that does not
  ///         propagate at the nominal wavelength.
  explicit RotaryOptics(const RotaryOpticsParameters& parameters);

  /// What both detectors show for a grating at X_LG. Takes the cheapest path that is exact for the parameters: the
  /// chief ray alone; a ray bundle; or all orders, windows, ghosts and blockers.
  PsdSignals Trace(const Eigen::Isometry3d& X_LG, const SourceState& source) const;

  /// The patches of light in each detector's plane, before the detector's own faults; the direct light first.
  ///
  /// Windows and ghosts are traced for the chief ray; the beam's extent gives every patch its covariance and the
  /// direct one the bundle's offset from the chief ray. Not included: change of a ghost's size on its way.
  std::array<std::vector<Spot>, 2> Spots(const Eigen::Isometry3d& X_LG, const SourceState& source) const;

  /// Irradiance on both detectors, `pixels` along u, square pixels, named "psd.p1" and "psd.m1".
  std::vector<IrradianceMap> Irradiance(const Eigen::Isometry3d& X_LG, const SourceState& source, int pixels) const;

  const Eigen::Isometry3d& X_LA() const { return X_LP_[0]; }
  const Eigen::Isometry3d& X_LB() const { return X_LP_[1]; }
  const RotaryOpticsParameters& parameters() const { return parameters_; }

  Ray ChiefRay(const SourceState& source) const;

 private:
  struct Bundle;   // what a ray bundle does in one detector's plane
  struct OnPlane;  // one ray in one detector's plane

  const PsdParameters& psd(int i) const { return i == 0 ? parameters_.psd_a : parameters_.psd_b; }
  PsdSignal TraceChief(const Frame& grating, const Ray& chief, const SourceState& source, int i) const;
  OnPlane TraceOrder(const Frame& grating, const Ray& ray, double wavelength_m, int i) const;
  Bundle TraceBundle(const BeamNodes& nodes, const Eigen::Isometry3d& X_LG, const Ray& chief, double wavelength_m,
                     int i) const;
  Bundle BundleOn(const Eigen::Isometry3d& X_LG, const Ray& chief, double wavelength_m, int i) const;
  bool Blocked(const Eigen::Isometry3d& X_LG, const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) const;
  std::vector<Deposit> Deposits(const Eigen::Isometry3d& X_LG, const Ray& chief, const SourceState& source) const;
  std::vector<Spot> SpotsOn(int i, const Bundle& bundle, const std::vector<Deposit>& deposits, double power_W,
                            double wavelength_m) const;
  double OrderPower(const Eigen::Isometry3d& X_LG, const Ray& chief, const SourceState& source, int i) const;

  RotaryOpticsParameters parameters_;
  std::array<Eigen::Isometry3d, 2> X_LP_;
  std::array<Frame, 2> planes_;
  BeamNodes nodes_;
  BeamNodes dense_nodes_;  // for a beam that is partly cut off
  std::optional<Scene> fixed_blockers_;
  std::optional<Scene> riding_blockers_;
  bool chief_only_ = false;
  bool split_ = false;  // windows or reflecting silicon: follow all paths
};

}  // namespace twinbench::optics
