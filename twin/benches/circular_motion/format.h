#pragma once

#include "twin/core/bench_format.h"

/// Circles of a machine tool, measured by a telescoping ball bar on a rotary encoder and by a grid plate.
namespace twinbench::benches::circular {

/// The text side of the bench; made at the first call, then constant.
const BenchFormat& Format();

// Its parts, one file each.
void AddKeys(std::vector<ScenarioKey>& keys, Scenario& s);
void CheckTogether(const ScenarioText& text, const Scenario& s);
std::vector<ReadingColumn> Columns();
std::vector<DesiredColumn> Desired();
std::string Addition(int setups);
std::vector<EffectEntry> Effects();

}  // namespace twinbench::benches::circular
