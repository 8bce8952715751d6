#include "twin/core/scenario_together.h"

#include <algorithm>

#include "twin/core/errors.h"
#include "twin/core/scenario_text.h"

namespace twinbench {

std::string Place(const ScenarioText& text, const std::string& key) {
  return text.Where(key, text.name() + ":1");
}

std::string Place(const ScenarioText& text, const std::string& key, const std::string& other) {
  return text.Where(key, Place(text, other));
}

void CheckPasses(const ScenarioText& text, const std::string& key, const std::vector<int>& passes) {
  if (std::find(passes.begin(), passes.end(), 0) != passes.end())
    throw InputError(Place(text, key), key + " has 0", "directions 1 or -1");
}

}  // namespace twinbench
