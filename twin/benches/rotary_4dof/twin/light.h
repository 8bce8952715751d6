#pragma once

#include <optional>

#include "optics/bench.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effect.h"
#include "twin/benches/rotary_4dof/twin/speckle.h"
#include "twin/core/scenario.h"

namespace twinbench::sim {

/// Where the light falls on both PSDs, in channel order, or why a reading of it is worth nothing.
struct Spots {
  ReadingStatus status = ReadingStatus::kOk;
  std::array<double, kChannels> uv_m{};
  std::array<double, 2> power_W{};  // on PSD A and B
};

/// Whether light is found as the scenario says, or quickly: by the closed form wherever it shows the same to a
/// nanometre.
enum class LightAsked { kAsStated, kQuickly };

/// Laser, grating and PSDs of a scenario.
class Light {
 public:
  /// @param nominal_wavelength_m  For which the PSDs were placed.
  /// @throws InputError if the beam's profile or the mesh of a fixture cannot be read.
  Light(const Scenario& actual, double nominal_wavelength_m, LightAsked asked);

  /// Wavelength and pointing at this temperature above the reference.
  LightState Nominal(double temperature_K) const;

  Spots Trace(const Pose& X_LG, const LightState& light) const;
  /// The same for many readings, as many lights as poses: the rays of all go together.
  std::vector<Spots> Trace(const std::vector<Pose>& X_LG, const std::vector<LightState>& lights) const;

  /// Rays that Embree has been asked to trace so far.
  std::uint64_t rays() const { return optics_.rays_traced(); }

  /// One multi-part OpenEXR with a picture of each PSD. @throws BenchError if it cannot be written.
  void WriteIrradiance(const std::string& path, const Pose& X_LG, const LightState& light) const;

 private:
  optics::SourceState SourceOf(const LightState& light) const;
  void Warm(const optics::PsdSignals& cold, const Pose& X_LG, const LightState& light, Spots& spots) const;
  void Dilute(std::size_t p, Spots& spots) const;
  Spots SpotsOf(const optics::PsdSignals& signals, const Pose& X_LG, const LightState& light) const;

  LaserSettings laser_;
  double low_light_fraction_;
  std::array<double, 2> post_growth_m_K_;  // of the PSDs
  std::array<double, 2> background_W_;
  Speckle speckle_;
  optics::RotaryOptics optics_;
  std::optional<optics::RotaryOptics> warm_optics_;  // where lengths grow with the temperature: kWarm_K warmer
  std::array<double, 2> nominal_power_W_{};
};

}  // namespace twinbench::sim
