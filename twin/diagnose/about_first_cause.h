#pragma once

#include <memory>
#include <vector>

#include "twin/diagnose/searched.h"

/// A cause that bends what is read is no column times a size: the search is made again with slopes about it.
namespace twinbench::diagnose {

/// The search with slopes about the cause that explains most, which is still weighed against the others: where what it leaves may
/// be nothing but that it was taken for linear, or its size is wrong by that. Structure without a name that leads may be nothing but
/// the bend of a cause that explains nearly as much.
/// @param before  Is as it was afterwards.
/// @return null where nothing is gained.
std::unique_ptr<Searched> SearchedAboutFirst(Searched& before, const std::vector<Reading>& readings, const DiagnoseOptions& options,
                                             const TwinComparison& comparison);

}  // namespace twinbench::diagnose
