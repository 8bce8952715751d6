#include "optics/bench_bundle.h"

#include <algorithm>

namespace twinbench::optics {

int ProfilePositions(const RotaryOpticsParameters& p) {
  constexpr int kProfilePositions = 1024;  // closed: enough for second moments
  return p.fidelity == Fidelity::kTraced ? p.beam.profile_rays : kProfilePositions;
}

/// Tile by tile, so that a beam of many rays stays in the cache on its way.
void RotaryOptics::VisitLandings(const BeamNodes& nodes, const Eigen::Isometry3d& X_LG, const Ray& chief,
                                 double wavelength_m, const Visit& visit) const {
  constexpr std::size_t kTile = 256;
  const BeamAxes axes = AxesAcross(chief.direction);
  const Frame grating = GratingFrame(X_LG);
  const GratingPoses poses({&X_LG, 1});
  RayBatch rays;
  DirectLight::Landings landings;
  for (std::size_t begin = 0; begin < nodes.size(); begin += kTile) {
    const std::size_t n = std::min(kTile, nodes.size() - begin);
    rays.Resize(n);
    for (std::size_t k = 0; k < n; ++k) rays.Set(k, NodeRay(chief, axes, nodes[begin + k]));
    if (traced_) traced_->Trace(poses, rays, {&wavelength_m, 1}, landings);
    for (int i = 0; i < 2; ++i) {
      auto& on = landings.on[static_cast<std::size_t>(i)];
      on.resize(n);
      for (std::size_t k = 0; closed_ && k < n; ++k)
        on[k] = closed_->Trace(grating, X_LG, rays.At(k), wavelength_m, i);
      visit(i, begin, on);
    }
  }
}

std::array<RotaryOptics::Bundle, 2> RotaryOptics::Bundles(const BeamNodes& nodes, const Eigen::Isometry3d& X_LG,
                                                          const Ray& chief, double wavelength_m) const {
  std::array<Moments, 2> moments;
  VisitLandings(nodes, X_LG, chief, wavelength_m, [&](int i, std::size_t begin, std::span<const Landing> landings) {
    const auto n = static_cast<std::size_t>(i);
    for (std::size_t k = 0; k < landings.size(); ++k) {
      if (landings[k].arrives) moments[n].Add(nodes[begin + k].weight, landings[k], X_LP_[n].linear());
    }
  });
  const bool alone = nodes.size() == 1;
  std::array<Bundle, 2> bundles = {moments[0].Summary(alone), moments[1].Summary(alone)};
  if (!closed_) return bundles;
  const Frame grating = GratingFrame(X_LG);
  for (int i = 0; i < 2; ++i) {
    Bundle& bundle = bundles[static_cast<std::size_t>(i)];
    const Landing centre = closed_->Reach(grating, chief, wavelength_m, i);
    if (bundle.share > 0.0 && centre.arrives) bundle.offset_m = bundle.mean_m - centre.in_air_m;
  }
  return bundles;
}

/// The few rays of a smooth rule; for an order that loses one of them, the many of a rule for hard edges.
std::array<RotaryOptics::Bundle, 2> RotaryOptics::BundlesOf(const Eigen::Isometry3d& X_LG, const Ray& chief,
                                                            double wavelength_m) const {
  const auto is_whole = [](const Bundle& b) { return b.share > 1.0 - 1e-9; };
  std::array<Bundle, 2> bundles = Bundles(nodes_, X_LG, chief, wavelength_m);
  if (dense_nodes_.empty() || (is_whole(bundles[0]) && is_whole(bundles[1]))) return bundles;
  const std::array<Bundle, 2> dense = Bundles(dense_nodes_, X_LG, chief, wavelength_m);
  for (std::size_t i = 0; i < 2; ++i) {
    if (!is_whole(bundles[i])) bundles[i] = dense[i];
  }
  return bundles;
}

}  // namespace twinbench::optics
