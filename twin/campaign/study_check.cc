#include "twin/campaign/study_check.h"

#include <algorithm>

#include "twin/core/errors.h"
#include "twin/uncertainty/standards.h"
#include "twin/core/number_text.h"

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

}  // namespace

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

}  // namespace twinbench::campaign
