#pragma once

#include <cstdint>

#include "twin/core/scenario.h"

namespace twinbench::uncertainty {

/// Whether there is anything that StandardsDrawn would draw.
bool StatesStandards(const Scenario& scenario);

/// A bench whose standards err as their statements allow: every u_<key> drawn (DrawnScenario), and where a list of
/// waves has a stated uncertainty beside it (`u_calibrator_arcsec` beside `calibrator`), both parts of its orders 1 to
/// 10 drawn with that standard deviation in place of the list. For the twin: evaluation believes what is written.
///
/// Trials have their own stretches of every stream.
Scenario StandardsDrawn(Scenario scenario, std::uint64_t seed, std::int64_t trial);

}  // namespace twinbench::uncertainty
