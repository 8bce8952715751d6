#include "twin/benches/freeform_five_axis/twin/light.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"

namespace twinbench::sim {

ProbeLight::ProbeLight(const FreeformSettings& bench, std::shared_ptr<const optics::HeightMap> form,
                       LightAsked asked)
    : bench_(bench), form_(std::move(form)) {
  must_be_closed_ = bench.optics.fidelity == "closed";
  may_be_closed_ = must_be_closed_ || (asked == LightAsked::kQuickly && bench.optics.IsPlain());
  if (must_be_closed_ && !bench.optics.IsPlain())
    throw InputError("optics.fidelity", "closed knows one spot of the stated size that has all of the light",
                     "traced, or optics.spot = \"stated\" and an ideal splitter and plate");
}

const TracedProbe& ProbeLight::Traced() {
  if (!traced_) traced_.emplace(bench_);
  return *traced_;
}

/// Does the light find all that the closed form takes for granted: free way, apertures, detectors? With a margin.
bool ProbeLight::IsSame(const ArtefactCell& cell, const Pose& X_FT, const ProbeSpot& spot) const {
  using Sizes = optics::SlopeProbeSizes;
  constexpr double kMargin = 0.8;
  constexpr double kAskew = 0.04;  // light with slopes s, t of its own loses (s t / 2)^2 to the laser: 2e-7 there
  const double radius_m = bench_.artefact.vertex_radius_m[(cell.i + cell.j) % 2 == 0 ? 0 : 1];
  const Vector3 plate = X_FT * Vector3(0.0, 0.0, Sizes::plate) -
                        Vector3(cell.i * bench_.artefact.pitch_m, cell.j * bench_.artefact.pitch_m, 0.0);
  const bool starts_inside = kMargin * plate.z() > plate.head<2>().squaredNorm() / (2.0 * radius_m);
  const bool on_cell = spot.hit_F.head<2>().norm() < kMargin * TracedProbe::Reach_m(radius_m);
  const bool beneath = spot.distance_m > -kMargin * Sizes::plate;
  const double slope = (spot.reflected_T.head<2>() / spot.reflected_T.z()).norm();
  const double walk_m = slope * (Sizes::lens + std::max(0.0, spot.distance_m));
  const bool through_lens = spot.reflected_T.z() > 0.0 && walk_m < kMargin * Sizes::clear;
  const bool on_detector = slope * bench_.qpd.lens_m < kMargin * 0.5 * Sizes::detector;
  const double seen_m = (Camera_px(bench_.ccd, spot.distance_m) - bench_.ccd.centre_px) * bench_.ccd.pixel_m;
  const double before_lens = 1.0 + spot.distance_m * std::cos(bench_.ccd.alpha_rad) / bench_.ccd.object_m;
  const bool seen = before_lens > 1.0 - kMargin && std::abs(seen_m) < kMargin * bench_.ccd.image_m;
  return slope < kAskew && starts_inside && on_cell && beneath && through_lens && on_detector && seen;
}

ProbeSignals ProbeLight::Show(const ArtefactCell& cell, const Pose& X_FT, double height_m,
                              const Eigen::Vector2d& spot_m) {
  if (may_be_closed_) {
    const ProbeSpot spot = Look(bench_.artefact, cell, X_FT, height_m, form_.get());
    if (must_be_closed_ || IsSame(cell, X_FT, spot)) {
      ProbeSignals shown;
      ShowQuadrants(bench_.qpd, OnQuadrants_m(bench_.qpd, spot) + spot_m, shown);
      shown.ccd_px = Camera_px(bench_.ccd, spot.distance_m);
      return shown;
    }
  }
  return Traced().Show(cell, X_FT, height_m, form_.get(), spot_m);
}

}  // namespace twinbench::sim
