#pragma once

#include "twin/core/bench_format.h"

/// A probe on a five-axis machine against an array of paraboloids.
namespace twinbench::benches::freeform {

/// The text side of the bench; made at the first call, then constant.
const BenchFormat& Format();

// Its parts, one file each.
void AddKeys(std::vector<ScenarioKey>& keys, Scenario& s);
std::vector<ReadingColumn> Columns();
std::vector<DesiredColumn> Desired();
std::vector<EffectEntry> Effects();

}  // namespace twinbench::benches::freeform
