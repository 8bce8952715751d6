#include "tests/hidden/twin_cases.h"

#include <utility>

#include "tests/support/truth_rows.h"
#include "tests/support/twin_run.h"
#include "twin/benches/names.h"
#include "twin/core/errors.h"

namespace twinbench::hidden {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// The generators' facts, by effect and key, as parameters of the catalogue. Facts whose meaning differs from the
/// parameter (a drift over the run, a creep's size at its end) stay out.
struct Fact {
  const char* key;
  const char* parameter;
  double factor = 1.0;
};
const std::vector<Fact>& Facts(const std::string& effect) {
  static const std::map<std::string, std::vector<Fact>> facts = {
      {"psd_gain", {{"gain_error", "gain_error"}}},
      {"psd_roll", {{"roll_rad", "roll"}}},
      {"psd_nonlinearity", {{"cubic_per_m2", "cubic"}}},
      {"stray_light", {{"fraction", "fraction"}}},
      {"wavelength_offset", {{"wavelength_error_m", "wavelength_error"}}},
      {"wavelength_temperature", {{"m_per_K", "wavelength_per_kelvin"}}},
      {"thermal_tilt", {{"rad_per_K", "tilt_per_kelvin"}}},
      {"backlash", {{"half_width_rad", "half_width"}}},
      {"crosstalk", {{"fraction", "fraction"}}},
      {"adc_step", {{"step_m", "step", 2000.0}}},
      {"scale", {{"ratio", "ratio"}}},
      {"latency", {{"seconds", "delay"}}},
      {"slip", {{"size", "angle"}, {"deg", "step", units::deg}}},
      {"bearing_half_frequency", {{"rad", "tilt"}}}};
  static const std::vector<Fact> none;
  const auto found = facts.find(effect);
  return found == facts.end() ? none : found->second;
}

Part PartOf(const json& truth) {
  Part part{truth.at("effect"), truth.at("where").is_null() ? "" : truth.at("where").get<std::string>(), {}};
  const json& facts = truth.at("facts");
  if (part.where.empty() && facts.contains("channel")) part.where = facts.at("channel");
  for (const Fact& fact : Facts(part.effect)) {
    if (facts.contains(fact.key)) part.parameters[fact.parameter] = fact.factor * facts.at(fact.key).get<double>();
  }
  return part;
}

/// What a signature has to say, from the generator's words for it.
std::string LockOf(const std::string& signature) {
  const std::vector<std::pair<std::string, std::string>> locks = {
      {"per pass", "pass"},          {"temperature", "temperature"}, {"direction", "direction"}, {"spot", "spot"},
      {"reference,", "both angles"}, {"per turn", "per turn"},       {"travelled", "angle"},
      {"together", "together"}};
  for (const auto& [theirs, ours] : locks) {
    if (signature.find(theirs) != std::string::npos) return ours;
  }
  return "time";
}

Hidden HiddenBy(const json& truth) {
  Hidden hidden;
  const std::string effect = truth.at("effect");
  if (truth.contains("alike")) hidden.alike = truth.at("alike").get<std::vector<std::string>>();
  if (effect == "none") return hidden;
  if (effect != "unknown") {
    hidden.causes = {PartOf(truth)};
    return hidden;
  }
  const std::string signature = truth.at("facts").at("signature");
  hidden.unlisted = truth.at("where");
  hidden.locks = {LockOf(signature)};
  hidden.channels = ChannelsIn(signature);  // of the two machine tools: none, they are not asked for
  return hidden;
}

Case ReadCase(const std::string& folder, const std::string& bench) {
  return {.hidden = HiddenBy(test::ReadTruthFile(folder + "/truth.json")),
          .scenario = LoadScenario(test::ScenarioPath(bench + ".toml")),
          .readings = ReadReadingsCsv(folder + "/readings.csv", bench)};
}

}  // namespace

std::string ChallengeSetOf(const std::string& bench) {
  if (bench == kRotaryBench) return "challenge";
  return "challenge_" + bench.substr(0, bench.find('_'));
}

std::vector<Plan> ChallengePlans(const std::string& folder, const std::string& bench) {
  std::vector<std::string> names;
  if (fs::is_directory(folder)) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (fs::exists(entry.path() / "truth.json")) names.push_back(entry.path().filename());
    }
  }
  if (names.empty()) throw InputError(folder, "holds no case", "folders with readings.csv and truth.json");
  std::ranges::sort(names);
  std::vector<Plan> plans;
  const std::string set = ChallengeSetOf(bench);
  for (const std::string& name : names) {
    const std::string path = folder + "/" + name;
    plans.push_back({set, name, [path, bench] { return ReadCase(path, bench); }});
  }
  return plans;
}

}  // namespace twinbench::hidden
