#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <vector>

#include "optics/beam.h"
#include "optics/fidelity.h"
#include "optics/ghosts.h"
#include "optics/mesh.h"

/// What the optics of the rotary bench are made of.
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
  int profile_rays = 16384;                                    // traced: places of the profile that are told apart
};

/// Something opaque in the way: fixed in L, or riding on the grating with its pose given in G.
struct Blocker {
  TriangleMesh mesh;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  bool rides_on_grating = false;
};

struct RotaryOpticsParameters {
  Fidelity fidelity = Fidelity::kTraced;
  double nominal_wavelength_m = std::numeric_limits<double>::quiet_NaN();  // the detectors are placed for it
  Eigen::Vector3d laser_position_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());  // in L
  Grating grating;
  PsdParameters psd_a;
  PsdParameters psd_b;
  BeamParameters beam;
  std::vector<Blocker> blockers;
  GhostOptions ghosts;

  const PsdParameters& psd(int i) const { return i == 0 ? psd_a : psd_b; }
};

/// Diffraction orders of the detectors A and B.
inline constexpr std::array<int, 2> kOrderOfPsd = {+1, -1};

}  // namespace twinbench::optics
