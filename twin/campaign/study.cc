#include "twin/campaign/study.h"

#include <algorithm>
#include <filesystem>

#include "twin/campaign/study_check.h"
#include "twin/campaign/vary_block.h"
#include "twin/core/errors.h"
#include "twin/core/input_text.h"
#include "twin/core/scenario_values.h"
#include "twin/core/schema_table.h"

namespace twinbench::campaign {
namespace {

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
