#pragma once

#include "twin/core/bench_format.h"

/// A turntable under a multi-tooth table with a mirror that an autocollimator reads.
namespace twinbench::benches::turntable {

/// The text side of the bench; made at the first call, then constant.
const BenchFormat& Format();

// Its parts, one file each.
void AddKeys(std::vector<ScenarioKey>& keys, Scenario& s);
void CheckTogether(const ScenarioText& text, const Scenario& s);
std::vector<ReadingColumn> Columns();
/// Some count the multi-tooth table's way back as positive. Here both tables count counter-clockwise, so that their
/// sum stays.
void CountBothTheSameWay(std::vector<Reading>& readings);
std::vector<DesiredColumn> Desired();
std::string Addition(int setups);
std::vector<EffectEntry> Effects();

}  // namespace twinbench::benches::turntable
