#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "optics/bench_parameters.h"
#include "optics/closed_light.h"
#include "optics/direct_light.h"
#include "optics/power_map.h"

/// The optics of the rotary bench: one laser, one grating, detectors for the orders +1 (A) and -1 (B).
///
/// Frame L: x dispersion, y nominal grating normal (towards laser and detectors), z up; frame G: x across the
/// grooves, y normal, z along the grooves. The laser shines along -y_L.
namespace twinbench::optics {

struct PsdSignals {
  PsdSignal a;
  PsdSignal b;
};

/// Traced, Embree finds every surface that light meets on its ways: grating, windows, silicon, fixtures; a measured
/// beam falls on the detectors pixel by pixel. Closed, the one way of the light is a formula, fixtures cast
/// shadows, and a measured beam counts by its second moments. Both agree to a nanometre wherever nothing of the
/// beam is cut off and it is not a measured one on a detector that is not linear (tests/optics/traced_test.cc).
///
/// Immutable after construction; Trace may run in several threads.
class RotaryOptics {
 public:
  /// @throws std::invalid_argument naming the field that is missing or out of range, or an order +-1 that does not
  ///         propagate at the nominal wavelength.
  explicit RotaryOptics(const RotaryOpticsParameters& parameters);

  /// What both detectors show for a grating at X_LG. Takes the cheapest path that is exact for the parameters: the
  /// chief ray alone; a ray bundle; or all orders, windows and ghosts too.
  PsdSignals Trace(const Eigen::Isometry3d& X_LG, const SourceState& source) const;

  /// The same for many readings: where the chief ray is all, the rays of all readings go together.
  /// @throws std::invalid_argument if there are not as many sources as poses.
  std::vector<PsdSignals> Trace(std::span<const Eigen::Isometry3d> X_LG,
                                std::span<const SourceState> sources) const;

  /// The patches of light in each detector's plane, before the detector's own faults; the direct light first.
  ///
  /// Ghosts are traced for the chief ray; the beam's extent gives every patch its covariance. Closed, the window is
  /// traced for the chief ray too, and the direct patch has the bundle's offset from it. Not included: change of a
  /// ghost's size on its way, change of the direct patch's size in the window (2e-4 of it).
  std::array<std::vector<Spot>, 2> Spots(const Eigen::Isometry3d& X_LG, const SourceState& source) const;

  /// Irradiance on both detectors, `pixels` along u, square pixels, named "psd.p1" and "psd.m1".
  std::vector<IrradianceMap> Irradiance(const Eigen::Isometry3d& X_LG, const SourceState& source, int pixels) const;

  const Eigen::Isometry3d& X_LA() const { return X_LP_[0]; }
  const Eigen::Isometry3d& X_LB() const { return X_LP_[1]; }
  const RotaryOpticsParameters& parameters() const { return parameters_; }

  Ray ChiefRay(const SourceState& source) const;

  /// Rays that Embree has been asked to trace so far; shadow rays do not count.
  std::uint64_t rays_traced() const { return traced_ ? traced_->scenes().rays_traced() : 0; }

 private:
  struct Bundle;   // what a ray bundle does in one detector's plane
  struct Moments;  // of which it is made
  /// Takes the landings of some rays in a row, from ray `begin` on, on detector `i`.
  using Visit = std::function<void(int i, std::size_t begin, std::span<const Landing> landings)>;

  const PsdParameters& psd(int i) const { return parameters_.psd(i); }
  Frame GratingFrame(const Eigen::Isometry3d& X_LG) const;

  PsdSignals TraceChief(const Eigen::Isometry3d& X_LG, const SourceState& source) const;
  PsdSignals TraceMeasured(const Eigen::Isometry3d& X_LG, const SourceState& source) const;
  PsdSignal ChiefSignal(const Frame& grating, const Ray& chief, const SourceState& source, const Landing& landing,
                        int i) const;

  void VisitLandings(const BeamNodes& nodes, const Eigen::Isometry3d& X_LG, const Ray& chief, double wavelength_m,
                     const Visit& visit) const;
  std::array<Bundle, 2> Bundles(const BeamNodes& nodes, const Eigen::Isometry3d& X_LG, const Ray& chief,
                                double wavelength_m) const;
  std::array<Bundle, 2> BundlesOf(const Eigen::Isometry3d& X_LG, const Ray& chief, double wavelength_m) const;

  std::vector<Deposit> Deposits(const Eigen::Isometry3d& X_LG, const Ray& chief, const SourceState& source) const;
  std::vector<Spot> SpotsOn(int i, const Bundle& bundle, const std::vector<Deposit>& deposits, double power_W,
                            double wavelength_m) const;
  double OrderPower(const Eigen::Isometry3d& X_LG, const Ray& chief, const SourceState& source, int i) const;

  /// A measured beam on one detector: its map, and the light of other ways.
  struct Measured {
    PowerMap map;
    std::vector<Spot> others;
  };
  std::array<Measured, 2> MeasuredLight(const Eigen::Isometry3d& X_LG, const SourceState& source) const;
  IrradianceMap DarkPicture(int i, const SourceState& source, int pixels) const;

  RotaryOpticsParameters parameters_;
  std::array<Eigen::Isometry3d, 2> X_LP_;
  BeamNodes nodes_;
  BeamNodes dense_nodes_;              // for a beam that is partly cut off
  std::optional<DirectLight> traced_;  // one of both
  std::optional<ClosedLight> closed_;
  bool split_ = false;     // windows or reflecting silicon: follow all paths
  bool measured_ = false;  // a measured beam, traced pixel by pixel
};

}  // namespace twinbench::optics
