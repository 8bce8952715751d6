#pragma once

#include <string>

#include "twin/core/scenario.h"
#include "twin/core/stream.h"

namespace twinbench::hidden {

/// An effect of the catalogue with a shape and a sign drawn at random. Its size is the plausible one of the
/// catalogue; SizedTo brings it to what a case wants.
///
/// @param where  One of the effect's places; empty if it has none.
EffectSettings DrawEffect(const std::string& name, const std::string& where, const Scenario& scenario,
                          Stream& stream);

}  // namespace twinbench::hidden
