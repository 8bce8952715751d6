#pragma once

#include <nlohmann/json_fwd.hpp>

#include "twin/investigate/investigation.h"

namespace twinbench::investigate {

/// investigation.json: "told", "ended", "minutes", "goal" {text, u, met}, "causes" [{name, probability, effects
/// [{effect, where, parameters}]}], "unlisted", "steps" [{number, run, words, sets, reason, minutes, expected_bit,
/// gained_bit, believed [{name, probability}], unlisted, u_goal}], "refused". Parameters are in the units of their
/// keys, with `u_` beside those that were fitted; what is not known is null.
nlohmann::json ToJson(const Investigation& investigation, const std::string& bench);

}  // namespace twinbench::investigate
