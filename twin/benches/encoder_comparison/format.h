#pragma once

#include "twin/core/bench_format.h"

/// Any angle device under test against any reference, at stops or in motion.
namespace twinbench::benches::encoder {

/// The text side of the bench; made at the first call, then constant.
const BenchFormat& Format();

// Its parts, one file each.
void AddKeys(std::vector<ScenarioKey>& keys, Scenario& s);
void CheckTogether(const ScenarioText& text, const Scenario& s);
std::vector<ReadingColumn> Columns();
std::vector<DesiredColumn> Desired();
ComparedColumns Compared();
std::string Addition(int setups);
std::vector<EffectEntry> Effects();

}  // namespace twinbench::benches::encoder
