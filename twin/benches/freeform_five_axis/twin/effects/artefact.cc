#include <cmath>

#include "twin/benches/freeform_five_axis/twin/effects/effects.h"
#include "twin/core/units.h"

namespace twinbench::sim {
namespace {

/// Stretched along the artefact's x: a cell stands off its place, as if all of it had been moved under the probe.
class ArtefactPitch : public FreeformEffect {
 public:
  ArtefactPitch(const EffectSettings& e, const Scenario& scenario)
      : ratio_(Parameter(e, "ratio")), own_(FreeformOf(scenario)) {}
  void Disturb(const FreeformMoment& moment, FreeformExtra& extra) override {
    const auto setup = static_cast<std::size_t>(moment.setup);
    const std::vector<MountSettings>& mounts = own_.freeform_procedure.mounts;
    const double yaw_rad = setup < mounts.size() ? mounts[setup].yaw_rad : 0.0;
    const double off_m = ratio_ * moment.cell.i * own_.artefact.pitch_m;
    extra.slipped_S_m += off_m * Vector3(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
  }

 private:
  double ratio_;
  FreeformSettings own_;
};

/// Cells that stand higher and lower: one wave over the array.
class ArtefactForm : public FreeformEffect {
 public:
  ArtefactForm(const EffectSettings& e, const Scenario& scenario)
      : cosine_m_(Parameter(e, "cosine")),
        sine_m_(Parameter(e, "sine")),
        waves_(Parameter(e, "waves") *
               Eigen::Vector2d(std::cos(Parameter(e, "azimuth")), std::sin(Parameter(e, "azimuth")))),
        side_(2 * FreeformOf(scenario).artefact.cells + 1) {}
  void Disturb(const FreeformMoment& moment, FreeformExtra& extra) override {
    const double phase_rad = units::turn * (waves_.x() * moment.cell.i + waves_.y() * moment.cell.j) / side_;
    extra.cell_height_m += cosine_m_ * std::cos(phase_rad) + sine_m_ * std::sin(phase_rad);
  }

 private:
  double cosine_m_, sine_m_;
  Eigen::Vector2d waves_;
  int side_;
};

}  // namespace

FreeformEffectPointer MakeArtefactPitch(const EffectSettings& e, const Scenario& scenario) {
  return std::make_unique<ArtefactPitch>(e, scenario);
}
FreeformEffectPointer MakeArtefactForm(const EffectSettings& e, const Scenario& scenario) {
  return std::make_unique<ArtefactForm>(e, scenario);
}

}  // namespace twinbench::sim
