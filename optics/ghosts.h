#pragma once

#include <array>
#include <functional>
#include <vector>

#include "optics/grating.h"
#include "optics/psd.h"

/// Every way the light takes between grating and detectors, traced and split, never guessed.
namespace twinbench::optics {

class RotaryScenes;

struct GhostOptions {
  int max_reflections = 3;  // at silicon and window faces; a silicon - grating - silicon round trip is one
  double threshold = 1e-7;  // paths weaker than this share of the laser's power are dropped
};

/// Two detectors about one grating.
struct GhostBench {
  Eigen::Isometry3d X_LG;
  const Grating* grating = nullptr;
  double wavelength_m = 0.0;
  std::array<const PsdParameters*, 2> psd{};
  std::array<Eigen::Isometry3d, 2> X_LP;
  std::function<bool(const Eigen::Vector3d&, const Eigen::Vector3d&)> blocked;  // empty: nothing in the way
  const RotaryScenes* scenes =
      nullptr;  // Embree finds what light meets, fixtures too; null: every surface is tried
};

/// Light that is absorbed in a detector's plane (also beside the active area, up to the package's edge).
struct Deposit {
  int detector = 0;
  double u_m = 0.0;
  double v_m = 0.0;
  double power_W = 0.0;
  int order = 0;                                          // at the first meeting with the grating
  int reflections = 0;                                    // 0: the direct light
  Eigen::Vector3d direction_P = Eigen::Vector3d::Zero();  // in front of any window
};

/// Follows one ray through all orders of the grating and all reflections, deterministically.
///
/// Fresnel phases and polarisation are not modelled: powers add, except between the faces of a window marked
/// coherent, whose internal reflections are left to Interfere().
std::vector<Deposit> TraceGhosts(const GhostBench& bench, const Ray& chief, double power_W,
                                 const GhostOptions& options);

}  // namespace twinbench::optics
