#pragma once

#include <string>
#include <vector>

#include "twin/core/bench_format.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/plausible/expected.h"
#include "twin/plausible/plan.h"

/// Are these readings what they say they are? Asked before any statistics, of any bench, with nothing but the
/// readings, the bench's columns and what the scenario says of its converters.
namespace twinbench::plausible {

/// Too few readings; values that the instrument cannot give; channels that are dead, or stuck while others move;
/// positions and directions that contradict the angles; times that stand still; rows that repeat; axes that stood
/// elsewhere; readings that come in steps as large as their noise; what is not as the scenario claims: of another
/// size, order or sign; what is not as it plans. Fatal ones first.
/// @param expected  What is claimed of the columns; of those that are left out nothing is.
std::vector<Finding> Check(const std::vector<Reading>& readings, const Scenario& scenario,
                           const std::vector<Expected>& expected = {}, const Plan& plan = {});

/// A line each, "cannot be: ..." or "doubtful: ...".
std::string InLines(const std::vector<Finding>& findings);

/// @throws InputError with the first fatal finding, if there is one.
/// @param where  The file or folder.
void RefuseFatal(const std::vector<Finding>& findings, const std::string& where);

}  // namespace twinbench::plausible
