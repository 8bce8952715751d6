#pragma once

#include <memory>
#include <vector>

#include "twin/diagnose/searched.h"

/// A cause that bends what is read is no column times a size: the search is made again with slopes about it.
namespace twinbench::diagnose {

/// Whether asking again with the first cause in the twin may tell more: it is named, and either what it leaves may
/// be nothing but that it was taken for linear, or its size is wrong by that.
bool MayBeCurved(const Searched& searched, const std::vector<Reading>& readings, const TwinComparison& comparison);

/// The same search with slopes about the first cause at the size that was found; it is still weighed against the
/// others. Null if other things can be searched for there.
std::unique_ptr<Searched> AboutFirstCause(const Searched& before, const std::vector<Reading>& readings,
                                          const DiagnoseOptions& options, const TwinComparison& comparison);

}  // namespace twinbench::diagnose
