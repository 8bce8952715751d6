#pragma once

#include <cstdint>

#include "optics/slope_probe.h"
#include "optics/triangulation.h"
#include "twin/benches/freeform_five_axis/twin/probe.h"

namespace twinbench::sim {

/// The probe over the artefact as light: from the laser through reducer, splitter and plate to the paraboloid and
/// its heights, back to the quadrant detector, and from the spot through the camera's lens to its line.
///
/// Embree finds every surface; scenes stand still, each in its own frame, and the rays are turned from one to the
/// other. A cell is met as the format has it, its paraboloid also beyond the middle to the next cell, up to a slope
/// of 45 deg. Immutable after construction; const members may run in several threads.
class TracedProbe {
 public:
  /// @throws InputError if the optics cannot be as the scenario says.
  explicit TracedProbe(const FreeformSettings& bench);

  /// What the detectors show without noise. Where no light comes to the camera ccd_px is NaN, and the quadrants
  /// show what stray light gives them.
  /// @param height_m, form  As in Look.
  /// @param spot_m  By which the quadrants' spot is off its place.
  ProbeSignals Show(const ArtefactCell& cell, const Pose& X_FT, double height_m, const optics::HeightMap* form,
                    const Eigen::Vector2d& spot_m) const;

  /// The light alone, for tests.
  optics::ProbeView View(const ArtefactCell& cell, const Pose& X_FT, double height_m,
                         const optics::HeightMap* form) const;

  /// Of a cell's paraboloid, from its vertex, as far as it is traced.
  static double Reach_m(double vertex_radius_m);

  /// Rays that Embree has been asked about so far.
  std::uint64_t rays() const;

 private:
  std::vector<optics::Spot> SpotsOf(const optics::ProbeView& view, const optics::ProbedSurface& surface) const;
  optics::ProbedSurface SurfaceUnder(const ArtefactCell& cell, const Pose& X_FT, double height_m,
                                     const optics::HeightMap* form) const;

  FreeformSettings bench_;
  optics::SlopeProbe head_;
  optics::Triangulation camera_;
  std::array<optics::FormedSurface, 2> paraboloids_;
};

}  // namespace twinbench::sim
