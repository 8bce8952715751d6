#pragma once

#include <memory>
#include <optional>

#include "twin/benches/freeform_five_axis/twin/traced_probe.h"

namespace twinbench::sim {

/// Whether light is found as the scenario says, or quickly: by the closed form wherever it shows the same to a
/// nanometre and a microvolt.
enum class LightAsked { kAsStated, kQuickly };

/// The probe's light, traced or by its closed form.
class ProbeLight {
 public:
  /// @param bench  Effects included. @param form  Null: the array has its form.
  /// @throws InputError if the closed form is to show what it does not know.
  ProbeLight(const FreeformSettings& bench, std::shared_ptr<const optics::HeightMap> form, LightAsked asked);

  /// As TracedProbe::Show.
  ProbeSignals Show(const ArtefactCell& cell, const Pose& X_FT, double height_m, const Eigen::Vector2d& spot_m);

  /// Rays that Embree has been asked about so far.
  std::uint64_t rays() const { return traced_ ? traced_->rays() : 0; }

 private:
  const TracedProbe& Traced();
  bool IsSame(const ArtefactCell& cell, const Pose& X_FT, const ProbeSpot& spot) const;

  FreeformSettings bench_;
  std::shared_ptr<const optics::HeightMap> form_;
  bool may_be_closed_ = false, must_be_closed_ = false;
  std::optional<TracedProbe> traced_;  // made when it is asked for
};

}  // namespace twinbench::sim
