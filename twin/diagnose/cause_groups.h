#pragma once

#include <vector>

#include "twin/diagnose/diagnosis.h"

namespace twinbench::diagnose {

/// Causes that these readings cannot tell from each other, most probable first; alone if there is no such rival.
using CauseGroup = std::vector<std::size_t>;  // indices of Diagnosis::causes

/// Every cause once, in the order of its first member.
std::vector<CauseGroup> GroupsOf(const std::vector<Cause>& causes);

/// What the group explains, of whichever of it was fitted; NaN of none.
/// @param share  Of each cause (Shown::share).
double ShareOf(const CauseGroup& group, const std::vector<double>& share);

/// Every cause once: the group that explains most first, behind them those of which no share is known.
std::vector<CauseGroup> GroupsByShare(const std::vector<Cause>& causes, const std::vector<double>& share);

/// What `member` of the group can imitate of its first cause, from 0 to 1; NaN if nobody said.
double Imitates(const std::vector<Cause>& causes, const CauseGroup& group, std::size_t member);

}  // namespace twinbench::diagnose
