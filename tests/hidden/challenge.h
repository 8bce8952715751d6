#pragma once

#include <string>
#include <vector>

#include "tests/hidden/hidden_case.h"

/// Cases of the independent generators: folders NNN with readings.csv and truth.json.
namespace twinbench::hidden {

/// "challenge" of the rotary bench, else with the first word of the bench's name: "challenge_circular".
std::string ChallengeSetOf(const std::string& bench);

/// @param bench  Decides the scenario that is believed.
/// @param excluded  Effects taken out of the catalogue.
/// @return one plan a folder, in the order of their names.
/// @throws InputError if there is no such folder or no case in it.
std::vector<Plan> ChallengePlans(const std::string& folder, const std::string& bench,
                                 const std::vector<std::string>& excluded = {});

}  // namespace twinbench::hidden
