#include "twin/campaign/study.h"

#include <algorithm>
#include <filesystem>

#include "twin/campaign/vary_block.h"
#include "twin/core/errors.h"
#include "twin/core/input_text.h"
#include "twin/core/number_text.h"
#include "twin/core/scenario_values.h"
#include "twin/core/schema_table.h"
#include "twin/uncertainty/standards.h"

namespace twinbench::campaign {
namespace {

/// Says at the study's line what the scenario said of an override; what does not go with other keys is left to the
/// trial, where those may differ too.
void RefuseAt(const std::string& where, const std::string& override_text, const InputError& error) {
  const std::string message = error.what(), prefix = "--set " + override_text + ": ", between = "; expected ";
  const std::size_t middle = message.rfind(between);
  if (!message.starts_with(prefix) || middle == std::string::npos) return;
  throw InputError(where, message.substr(prefix.size(), middle - prefix.size()),
                   message.substr(middle + between.size()));
}

void Try(const Study& study, const std::string& where, const std::string& override_text) {
  try {
    study.With({override_text});
  } catch (const InputError& error) {
    RefuseAt(where, override_text, error);
  }
}

/// What a grid gives, or what a distribution gives at 0.1 %, in the middle and at 99.9 %.
std::vector<std::string> ValuesOf(const Variation& variation) {
  if (const auto* grid = std::get_if<Grid>(&variation.how)) return grid->values;
  std::vector<std::string> values;
  for (const double p : {0.001, 0.5, 0.999})
    values.push_back(PrintInUnit(Quantile(std::get<Distribution>(variation.how), p), 1.0));
  return values;
}

void CheckVariation(const Study& study, const Variation& variation) {
  if (variation.key == "seed" || variation.key == "bench")
    throw InputError(variation.location, "the key " + variation.key + " cannot be varied",
                     variation.key == "seed" ? "the seed of the study, which gives every trial its own"
                                             : "one bench in one study");
  const Variation& first = *std::ranges::find(study.vary, variation.key, &Variation::key);
  if (&first != &variation)
    throw InputError(variation.location, "the key " + variation.key + " is varied twice, first in " + first.location, "one [[vary]] for a key");
  for (const std::string& value : ValuesOf(variation)) Try(study, variation.location, variation.key + "=" + value);
}

/// Gives the base scenario every key as the trials will: all values of grids, the ends and the middle of
/// distributions.
/// @param set_where  File and line of the study's `set`.
/// @throws InputError, with the line of the study, if the scenario refuses one of them by itself.
void CheckStudy(const Study& study, const std::string& set_where) {
  try {
    study.With({});
  } catch (const InputError& error) {
    for (const std::string& option : study.set) RefuseAt(set_where, option, error);
    throw;
  }
  if (study.standards && !uncertainty::StatesStandards(study.With({})))
    throw InputError(study.scenario_name, "the scenario states no uncertainty that could be drawn",
                     "u_<key> beside a key, or no standards = true");
  for (const Variation& variation : study.vary) CheckVariation(study, variation);
}

constexpr double kMostAtAPoint = 1e7;

/// What the file says, before it is looked at.
struct StudyFile {
  std::string scenario, scenario_text, sampling = "random", estimator = "rigorous";
  std::vector<std::string> set;
  std::uint64_t seed = 1;
  int trials = 1;
  bool diagnosis = false, standards = false;
};

schema::Keys KeysOf(StudyFile& file) {
  schema::Keys keys;
  schema::Table top(keys, "");
  top.Text("scenario", &file.scenario, {}, "file of the base scenario, named from the study's folder");
  top.Text("scenario_text", &file.scenario_text, {}, "the base scenario itself, instead of a file");
  top.Text("set", &file.set, {}, "keys of the base scenario to change in every trial, as after --set");
  top.Add("seed", {}, {}, &file.seed, "of the study: the seed of a trial follows from it and the trial's number");
  top.Add("trials", {}, {1.0, kMostAtAPoint}, &file.trials, "at every point of the grids");
  top.Text("sampling", &file.sampling, {"random", "latin_hypercube"}, "how distributions are sampled");
  top.Text("estimator", &file.estimator, {"published", "rigorous"}, "that evaluates every trial");
  top.Flag("standards", file.standards,
           "the twin has every u_<key> drawn, and errors are compared with combined uncertainties");
  top.Flag("diagnosis", file.diagnosis, "also diagnose every trial and keep the verdict");
  return keys;
}

std::vector<Variation> ReadVariations(const ScenarioText& text) {
  const auto blocks = text.Find("vary");
  if (!blocks) return {};
  const toml::array* list = blocks->node().as_array();
  if (!list) throw InputError(blocks->Where(), "vary is " + blocks->Found(), "[[vary]] blocks");
  std::vector<Variation> all;
  for (const toml::node& block : *list) all.push_back(ReadVariation(blocks->With(block)));
  return all;
}

StudyFile ReadStudyFile(const ScenarioText& text) {
  StudyFile file;
  const schema::Keys keys = KeysOf(file);
  std::vector<KnownKey> known = KnownKeys(keys);
  known.push_back({"", "vary", ""});
  const TomlSource& source = text.sources().front();
  for (const auto& [key, node] : source.root) {
    const std::string name(key.str());
    const auto found = std::ranges::find(known, name, &KnownKey::Path);
    if (found == known.end()) throw UnknownKey(TomlValue(node, source).Where(), "", name, known);
  }
  for (const ScenarioKey& key : keys) {
    if (const auto value = text.Find(key.Path())) ReadKey(key, *value);
  }
  return file;
}

void FindScenario(const ScenarioText& text, const StudyFile& file, const std::string& folder, Study& study) {
  if (file.scenario.empty() == file.scenario_text.empty())
    throw InputError(text.Where("scenario", text.name() + ":1"),
                     file.scenario.empty() ? "the study has no scenario" : "the study has two scenarios",
                     "either scenario = \"FILE.toml\" or scenario_text = '''...'''");
  if (file.scenario.empty()) {
    study.scenario_name = text.Where("scenario_text", text.name()) + " (scenario_text)";
    study.scenario_text = file.scenario_text;
    study.scenario_folder = folder;
    return;
  }
  const std::filesystem::path path = std::filesystem::path(folder) / file.scenario;
  study.scenario_name = path.lexically_normal().string();
  study.scenario_text = InputText(study.scenario_name, "a scenario in TOML", text.Where("scenario", text.name()));
  study.scenario_folder = path.parent_path().string();
}

}  // namespace

Scenario Study::With(const std::vector<std::string>& overrides) const {
  std::vector<std::string> all = set;
  all.insert(all.end(), overrides.begin(), overrides.end());
  return ParseScenario(scenario_text, scenario_name, scenario_folder, all);
}

Study ParseStudy(const std::string& text, const std::string& name, const std::string& folder) {
  const ScenarioText source(text, name, {});
  const StudyFile file = ReadStudyFile(source);
  Study study;
  study.text = text;
  study.set = file.set;
  study.seed = file.seed;
  study.trials = file.trials;
  study.sampling = file.sampling == "random" ? Sampling::kRandom : Sampling::kLatinHypercube;
  study.estimator = EstimatorNamed(file.estimator);
  study.diagnosis = file.diagnosis;
  study.standards = file.standards;
  study.vary = ReadVariations(source);
  FindScenario(source, file, folder, study);
  CheckStudy(study, source.Where("set", name + ":1"));
  return study;
}

Study LoadStudy(const std::string& path) {
  return ParseStudy(InputText(path, "a study in TOML"), path,
                    std::filesystem::path(path).parent_path().string());
}

}  // namespace twinbench::campaign
