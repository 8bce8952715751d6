#include "twin/benches/freeform_five_axis/twin/twin.h"

#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/core/bench_format.h"
#include "twin/core/errors.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"
#include "twin/sim/changed_keys.h"
#include "twin/sim/truth.h"

namespace twinbench::sim {
namespace {

using namespace benches::freeform;

void DrawErrors(Stream& random, MachineSettings& m) {
  constexpr std::array<double, kCubicTerms> kShare = {1.0, 1.0, 0.7, 0.5};
  for (auto& body : m.errors) {
    for (std::size_t k = 0; k < kBodyErrors; ++k) {
      const double sd = IsRotation(static_cast<int>(k)) ? m.random_rotation_rad : m.random_translation_m;
      for (std::size_t c = 0; c < kCubicTerms; ++c) body[k][c] += kShare[c] * sd * random.Normal();
    }
  }
  for (double& squareness_rad : m.squareness_rad) squareness_rad += m.random_squareness_rad * random.Normal();
}

FreeformMoment MomentOf(const Reading& r, double run_share, const EnvironmentSettings& room) {
  FreeformMoment moment;
  moment.reading = r.reading;
  moment.setup = r.setup;
  moment.time_s = ToSeconds(r.time);
  moment.run_share = run_share;
  moment.direction = r.direction;
  if (std::isfinite(r.temperature_degC)) moment.above_K = r.temperature_degC - room.reference_degC;
  for (std::size_t axis = 0; axis < kCommanded.size(); ++axis) moment.at[axis] = kCommanded[axis](r);
  moment.cell = {static_cast<int>(kCellI(r)), static_cast<int>(kCellJ(r))};
  return moment;
}

MachineErrors Sum(MachineErrors a, const MachineErrors& b) {
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    for (std::size_t k = 0; k < kBodyErrors; ++k) a.body[axis][k] += b.body[axis][k];
  }
  for (std::size_t k = 0; k < kSquarenesses; ++k) a.squareness_rad[k] += b.squareness_rad[k];
  return a;
}

/// A record of somebody else may have more set-ups than the scenario: where the artefact stood then is unknown.
template <class Entry>
Entry Of(const std::vector<Entry>& entries, int setup) {
  const auto at = static_cast<std::size_t>(setup);
  return at < entries.size() ? entries[at] : Entry{};
}

/// Read once for all twins: a diagnosis makes thousands of them.
std::shared_ptr<const optics::HeightMap> FormOf(const ArtefactSettings& artefact) {
  if (artefact.form_error.empty()) return nullptr;
  static std::mutex one_at_a_time;
  static std::map<std::string, std::shared_ptr<const optics::HeightMap>> read;
  const std::scoped_lock lock(one_at_a_time);
  std::shared_ptr<const optics::HeightMap>& form = read[artefact.form_error];
  if (form) return form;
  try {
    form = std::make_shared<const optics::HeightMap>(optics::ReadHeightMap(artefact.form_error));
  } catch (const std::runtime_error& error) {
    throw InputError("artefact.form_error", error.what(), "an OpenEXR file with a channel Y and a pixel pitch");
  }
  return form;
}

FreeformSettings ActualOf(Scenario scenario) {
  ChangeKeys(scenario);
  return FreeformOf(scenario);
}

}  // namespace

DrawnBench Draw(const Scenario& scenario) {
  const FreeformSettings& own = FreeformOf(scenario);
  DrawnBench drawn{own.machine, {}};
  Stream machine(scenario.seed, "machine.errors"), mounting(scenario.seed, "artefact.mounting");
  DrawErrors(machine, drawn.machine);
  for (std::size_t setup = 0; setup < own.freeform_procedure.mounts.size(); ++setup) {
    BodyError& error = drawn.mountings.emplace_back();
    for (std::size_t k = 0; k < kBodyErrors; ++k)
      error[k] = mounting.Normal() *
                 (IsRotation(static_cast<int>(k)) ? own.artefact.mounting_rad : own.artefact.mounting_m);
  }
  return drawn;
}

FreeformTwin::FreeformTwin(const Scenario& scenario, DrawnBench drawn, LightAsked asked)
    : scenario_(scenario), actual_(ActualOf(scenario)), drawn_(std::move(drawn)) {
  static const EffectMakers<FreeformEffect> makers = Merged(MachineEffects(), DetectorEffects());
  for (const EffectSettings& effect : BeyondKeys(scenario)) effects_.push_back(MakeBy(makers, effect, scenario));
  light_ = std::make_unique<ProbeLight>(actual_, FormOf(actual_.artefact), asked);
  for (const std::string& channel : FormatOf(scenario.bench).channels)
    empirical_.emplace_back(scenario.empiricals, channel);
}

ProbeSignals FreeformTwin::Show(const Reading& reading, double run_share, FreeformExtra extra) {
  const FreeformMoment moment = MomentOf(reading, run_share, scenario_.environment);
  for (const auto& effect : effects_) effect->Disturb(moment, extra);
  const MachineErrors errors = Sum(ErrorsAt(drawn_.machine, moment.at), extra.machine);
  BodyError mounting = Of(drawn_.mountings, moment.setup);
  for (std::size_t k = 0; k < kBodyErrors; ++k) mounting[k] += extra.mounting[k];
  const Pose X_MF = X_MS(moment.at, errors) * Eigen::Translation3d(extra.slipped_S_m) *
                    X_SF(Of(actual_.freeform_procedure.mounts, moment.setup), mounting);
  ProbeSignals shown = light_->Show(moment.cell, X_MF.inverse() * X_MT(moment.at, errors, actual_.machine.pivot_m),
                                    extra.cell_height_m, extra.spot_m);
  for (const auto& effect : effects_) effect->AlterSignals(moment, shown);
  shown.qpd_x_V += extra.qpd_x_V + empirical_[0].At(moment.reading, moment.time_s);
  shown.qpd_y_V += extra.qpd_y_V + empirical_[1].At(moment.reading, moment.time_s);
  shown.ccd_px += extra.ccd_px + empirical_[2].At(moment.reading, moment.time_s);
  return shown;
}

nlohmann::json FreeformTruth(const Scenario& scenario, const DrawnBench& drawn) {
  const auto unit = [](std::size_t k) { return IsRotation(static_cast<int>(k)) ? units::arcsec : units::um; };
  nlohmann::json errors, squareness, mountings = nlohmann::json::array();
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    for (std::size_t k = 0; k < kBodyErrors; ++k) {
      CubicError c = drawn.machine.errors[axis][k];
      for (double& coefficient : c) coefficient /= unit(k);
      errors[std::string(kAxisNames[axis]) + "." + kBodyErrorNames[k]] = {
          {"unit", IsRotation(static_cast<int>(k)) ? "arcsec" : "um"}, {"coefficients", c}};
    }
  }
  for (std::size_t k = 0; k < kSquarenesses; ++k)
    squareness[kSquarenessNames[k]] = drawn.machine.squareness_rad[k] / units::arcsec;
  for (const BodyError& mounting : drawn.mountings) {
    nlohmann::json one;
    for (std::size_t k = 0; k < kBodyErrors; ++k)
      one[std::string(kBodyErrorNames[k]) + (IsRotation(static_cast<int>(k)) ? "_arcsec" : "_um")] =
          mounting[k] / unit(k);
    mountings.push_back(one);
  }
  return {{"machine", {{"errors", errors}, {"squareness_arcsec", squareness}}},
          {"mountings", mountings},
          {"effects", ToJson(scenario.effects)},
          {"seed", scenario.seed}};
}

}  // namespace twinbench::sim
