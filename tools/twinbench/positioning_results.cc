#include "tools/twinbench/positioning_results.h"

#include <fmt/core.h>

#include <cmath>
#include <set>

#include "tools/twinbench/json_units.h"
#include "twin/core/units.h"
#include "twin/measure/iso230_2.h"

namespace twinbench::tools {
namespace {

using measure::ApproachPositioning;
using measure::AxisPositioning;
using measure::ScatteredValue;
using measure::TargetPositioning;

constexpr std::size_t kMostRows = 40;  // a table that is still looked at

nlohmann::json ToJson(const ScatteredValue& v) {
  return {{"value_arcsec", Arcsec(v.value)}, {"u_arcsec", Arcsec(v.u)}, {"bias_arcsec", Arcsec(v.bias)}};
}

nlohmann::json ToJson(const ApproachPositioning& a) {
  return {{"runs", a.runs},
          {"mean_arcsec", Arcsec(a.mean)},
          {"u_mean_arcsec", Arcsec(a.u_mean)},
          {"standard_deviation_arcsec", Arcsec(a.deviation)}};
}

nlohmann::json ToJson(const TargetPositioning& t) {
  return {{"position_deg", t.position / units::deg},
          {"forward", ToJson(t.forward)},
          {"backward", ToJson(t.backward)},
          {"mean_arcsec", Arcsec(t.mean)},
          {"u_mean_arcsec", Arcsec(t.u_mean)},
          {"reversal_arcsec", Arcsec(t.reversal)},
          {"u_reversal_arcsec", Arcsec(t.u_reversal)},
          {"repeatability", ToJson(t.repeatability)}};
}

nlohmann::json AxisJson(const AxisPositioning& positioning) {
  nlohmann::json json = nlohmann::json::object();
  for (std::size_t i = 0; i < measure::kAxisValues; ++i)
    json[measure::kAxisValueNames[i]] = ToJson(positioning.axis[i]);
  return json;
}

void Append(int setup, const measure::PositioningStops& stops, PositioningResults& results) {
  const AxisPositioning positioning = measure::EvaluatePositioning(stops.targets);
  const double travel_rad = stops.targets.back().position - stops.targets.front().position;
  const std::vector<std::string> missing = measure::MissingForRotaryAxis(stops.targets, travel_rad);
  nlohmann::json targets = nlohmann::json::array();
  for (const TargetPositioning& target : positioning.targets) targets.push_back(ToJson(target));
  results.json.push_back({{"setup", setup},
                          {"axis", AxisJson(positioning)},
                          {"targets", targets},
                          {"left_out", stops.left_out},
                          {"missing", missing},
                          {"notes", stops.notes}});
  results.text +=
      fmt::format("set-up {}, {} targets over {:.4g} deg\n", setup, targets.size(), travel_rad / units::deg);
  results.text += targets.size() <= kMostRows ? PositioningText(positioning) : AxisText(positioning);
  for (const std::string& what : missing) results.text += "missing: " + what + "\n";
}

}  // namespace

PositioningResults EvaluateStops(const std::vector<Reading>& readings) {
  PositioningResults results;
  results.json = nlohmann::json::array();
  std::set<int> setups;
  for (const Reading& reading : readings) setups.insert(reading.setup);
  for (const int setup : setups) {
    const measure::PositioningStops stops = measure::PositioningOf(readings, setup);
    if (!stops.targets.empty()) Append(setup, stops, results);
  }
  return results;
}

}  // namespace twinbench::tools
