#include "twin/benches/encoder_comparison/parts_of_results.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "twin/benches/encoder_comparison/axis_unit.h"
#include "twin/benches/encoder_comparison/estimators/iso230_2.h"
#include "twin/benches/encoder_comparison/estimators/vdi3441.h"
#include "twin/core/units.h"
#include "twin/report/json_units.h"

namespace twinbench::benches::encoder {
namespace {

using measure::ApproachPositioning;
using measure::AxisPositioning;
using measure::ScatteredValue;
using measure::TargetPositioning;

constexpr std::size_t kMostRows = 40;  // a table that is still looked at

nlohmann::json ToJson(const ScatteredValue& v) {
  return {{"value_arcsec", report::Arcsec(v.value)},
          {"u_arcsec", report::Arcsec(v.u)},
          {"bias_arcsec", report::Arcsec(v.bias)}};
}

nlohmann::json ToJson(const ApproachPositioning& a) {
  return {{"runs", a.runs},
          {"mean_arcsec", report::Arcsec(a.mean)},
          {"u_mean_arcsec", report::Arcsec(a.u_mean)},
          {"standard_deviation_arcsec", report::Arcsec(a.deviation)}};
}

nlohmann::json ToJson(const TargetPositioning& t) {
  return {{"position_deg", t.position / units::deg},
          {"forward", ToJson(t.forward)},
          {"backward", ToJson(t.backward)},
          {"mean_arcsec", report::Arcsec(t.mean)},
          {"u_mean_arcsec", report::Arcsec(t.u_mean)},
          {"reversal_arcsec", report::Arcsec(t.reversal)},
          {"u_reversal_arcsec", report::Arcsec(t.u_reversal)},
          {"repeatability", ToJson(t.repeatability)}};
}

template <std::size_t kSize>
nlohmann::json AxisJson(const std::array<const char*, kSize>& names, const std::array<ScatteredValue, kSize>& axis) {
  nlohmann::json json = nlohmann::json::object();
  for (std::size_t i = 0; i < kSize; ++i) json[names[i]] = ToJson(axis[i]);
  return json;
}

/// All uncertainties here are made of what the runs scatter by (`u_parts`).
nlohmann::json OfScatterAlone() {
  return {{"repeatability", 1.0}};
}

/// What a test lacks of VDI/DGQ 3441: five runs from both sides. Not checked: how many targets, how they are spaced.
std::vector<std::string> MissingForVdi3441(const std::vector<TargetPositioning>& targets) {
  constexpr int kRuns = 5;
  for (const TargetPositioning& t : targets) {
    if (const int runs = std::min(t.forward.runs, t.backward.runs); runs < kRuns)
      return {fmt::format("{} runs from one side to the target at {:.4g} deg; VDI/DGQ 3441 wants {}", runs, t.position / units::deg, kRuns)};
  }
  return {};
}

/// Some places were reached twice: a table of a firmware or a single pass has nothing to say of reversals and repeats,
/// and a device that is held at one place or two has no axis to test.
bool IsPositioningTest(const std::vector<TargetPositioning>& targets) {
  constexpr std::ptrdiff_t kFewest = 3;
  return std::ranges::count_if(targets, [](const TargetPositioning& t) { return t.forward.runs + t.backward.runs > 1; }) >= kFewest;
}

/// @return what there is to say of it.
std::string AppendVdi(int setup, const std::vector<TargetPositioning>& targets, const measure::ToldIn& told, PositioningResults& results) {
  const measure::VdiPositioning vdi = measure::EvaluateVdi3441(targets);
  results.vdi.push_back({{"setup", setup}, {"axis", AxisJson(measure::kVdiValueNames, vdi.axis)}, {"u_parts", OfScatterAlone()}, {"missing", MissingForVdi3441(targets)}});
  return VdiText(vdi, told);
}

void Append(int setup, const measure::PositioningStops& stops, const DeviceSettings& device, const measure::RunRounding& rounding,
            PositioningResults& results) {
  const AxisPositioning positioning = measure::EvaluatePositioning(stops.targets, {}, rounding);
  const double travel_rad = stops.targets.back().position - stops.targets.front().position;
  const AxisUnit coarse = CoarseUnit(device), fine = FineUnit(device);
  const measure::ToldIn told{coarse.name, coarse.to_SI, fine.name, fine.to_SI};
  const std::vector<std::string> missing =
      device.turn_m > 0.0
          ? measure::MissingForLinearAxis(stops.targets, travel_rad / units::turn * device.turn_m, told)
          : measure::MissingForRotaryAxis(stops.targets, travel_rad);
  nlohmann::json targets = nlohmann::json::array();
  for (const TargetPositioning& target : positioning.targets) targets.push_back(ToJson(target));
  results.json.push_back({{"setup", setup},
                          {"axis", AxisJson(measure::kAxisValueNames, positioning.axis)},
                          {"targets", targets},
                          {"u_parts", OfScatterAlone()},
                          {"left_out", stops.left_out},
                          {"missing", missing},
                          {"notes", stops.notes}});
  const std::string vdi_text = AppendVdi(setup, positioning.targets, told, results);
  if (!IsPositioningTest(positioning.targets)) return;
  results.text += fmt::format("mounting {}, {} targets over {:.4g} {}\n", setup, targets.size(),
                              travel_rad / coarse.to_SI, coarse.name);
  results.text += targets.size() <= kMostRows ? PositioningText(positioning, told) : AxisText(positioning, told);
  results.text += vdi_text;
  for (const std::string& what : missing) results.text += "short of a standard: " + what + "\n";
}

}  // namespace

PositioningResults EvaluateStops(const std::vector<Reading>& readings, const DeviceSettings& device,
                                 const separate::encoder::ScaleSteps& stated) {
  const separate::encoder::ScaleSteps steps = separate::encoder::WithOwnStep(stated, readings);
  PositioningResults results;
  results.json = results.vdi = nlohmann::json::array();
  std::set<int> setups;
  for (const Reading& reading : readings) setups.insert(reading.setup);
  for (const int setup : setups) {
    const measure::PositioningStops stops = measure::PositioningOf(readings, setup);
    if (!stops.targets.empty())
      Append(setup, stops, device, measure::RoundingOfTargets(stops.targets, steps.step_rad, steps.at_once), results);
  }
  return results;
}

}  // namespace twinbench::benches::encoder
