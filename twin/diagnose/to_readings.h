#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/by_twin.h"
#include "twin/diagnose/compared.h"

/// From a search over groups of neighbouring readings back to the readings.
namespace twinbench::diagnose {

/// Readings that were left out because they lie far outside, as a cause; none if there are none.
/// @param excluded  Causes that are not in the catalogue.
std::vector<Cause> OutliersLeftOut(const Compared& compared, const TwinComparison& comparison,
                                   const std::vector<std::string>& excluded);

/// Gives structure without a name a value at every reading, between those of the groups; makes one cause of all
/// outliers, whether they were found as readings or as groups; counts readings; tabulates the comparison's orders.
void ToReadings(const Compared& compared, const TwinComparison& comparison, DiagnosisRun& result);

}  // namespace twinbench::diagnose
