#pragma once

#include "twin/core/bench_format.h"

/// A hobbing machine with ring encoders on table and hob spindle: its transmission error.
namespace twinbench::benches::hob {

/// The text side of the bench; made at the first call, then constant.
const BenchFormat& Format();

// Its parts, one file each.
void AddKeys(std::vector<ScenarioKey>& keys, Scenario& s);
void CheckTogether(const ScenarioText& text, const Scenario& s);
std::vector<ReadingColumn> Columns();
std::vector<DesiredColumn> Desired();
std::string Addition(int setups);
std::vector<EffectEntry> Effects();

}  // namespace twinbench::benches::hob
