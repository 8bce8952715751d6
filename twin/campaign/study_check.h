#pragma once

#include "twin/campaign/study.h"

namespace twinbench::campaign {

/// Gives the base scenario every key as the trials will: all values of grids, the ends and the middle of
/// distributions.
/// @param set_where  File and line of the study's `set`.
/// @throws InputError, with the line of the study, if the scenario refuses one of them by itself.
void CheckStudy(const Study& study, const std::string& set_where);

}  // namespace twinbench::campaign
