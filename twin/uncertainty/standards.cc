#include "twin/uncertainty/standards.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "twin/core/harmonic_settings.h"
#include "twin/core/scenario_schema.h"
#include "twin/core/stream.h"
#include "twin/uncertainty/monte_carlo.h"

namespace twinbench::uncertainty {
namespace {

constexpr int kHighestDrawn = 10;

/// A list of waves, and the standard uncertainty of either part of each of its orders.
struct StatedWaves {
  std::string path;
  std::vector<HarmonicSettings>* waves = nullptr;
  double u = 0.0;
};

std::vector<StatedWaves> StatedWavesOf(const std::vector<ScenarioKey>& keys) {
  std::vector<StatedWaves> all;
  for (const ScenarioKey& list : keys) {
    auto* const* waves = std::get_if<std::vector<HarmonicSettings>*>(&list.field);
    if (!waves) continue;
    const auto stated = std::ranges::find_if(
        keys, [&](const ScenarioKey& k) { return k.table == list.table && k.name == "u_" + list.name; });
    if (stated == keys.end()) continue;
    auto* const* u = std::get_if<double*>(&stated->field);
    if (u && **u > 0.0) all.push_back({list.Path(), *waves, **u});
  }
  return all;
}

void Draw(const StatedWaves& stated, Stream& stream) {
  stated.waves->clear();
  for (int order = 1; order <= kHighestDrawn; ++order) {
    const double real = stated.u * stream.Normal(), imaginary = stated.u * stream.Normal();
    HarmonicSettings& wave = stated.waves->emplace_back();
    wave.order = order;
    wave.amplitude = std::hypot(real, imaginary);
    wave.phase_rad = std::atan2(imaginary, real);
  }
}

}  // namespace

bool StatesStandards(const Scenario& scenario) {
  Scenario copy = scenario;
  return !scenario.uncertainties.empty() || !StatedWavesOf(KeysOf(copy)).empty();
}

Scenario StandardsDrawn(Scenario scenario, std::uint64_t seed, std::int64_t trial) {
  Scenario drawn = DrawnScenario(std::move(scenario), seed, trial);
  for (const StatedWaves& stated : StatedWavesOf(KeysOf(drawn))) {
    Stream stream(seed, "uncertainty." + stated.path);
    stream.Seek(static_cast<std::uint64_t>(trial) << 8);
    Draw(stated, stream);
  }
  return drawn;
}

}  // namespace twinbench::uncertainty
