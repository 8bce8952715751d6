#pragma once

#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"

namespace twinbench::sim {

/// [[empirical]] tables by reading belong to the run that showed them, which is known by its times: on a record in
/// which a reading of the same number was taken at another time such a table is left out. One that states no times
/// is kept.
void LeaveOutForeignTables(const std::vector<Reading>& record, std::vector<EmpiricalSettings>& empiricals);

}  // namespace twinbench::sim
