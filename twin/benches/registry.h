#pragma once

#include <string>
#include <vector>

#include "twin/core/bench.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/diagnose.h"

/// The benches that this program has, by their names.
namespace twinbench {

/// In the order of BenchFormats. The list itself is all.cc; a program that is linked with another one has other
/// benches, as tests/trial does.
const std::vector<const Bench*>& Benches();

/// The bench of that name.
/// @throws InputError if there is none, naming those there are.
const Bench& BenchNamed(const std::string& name);
const Bench& BenchOf(const Scenario& scenario);

/// Names in words the benches for which `holds`, for refusals: "bench a or b".
std::string BenchesWhere(const std::function<bool(const Bench&)>& holds);

namespace diagnose {

/// The diagnosis of the scenario's bench, with what it lacks for want of columns.
/// @param readings  Of the scenario's bench, any phases; unusable ones are left out and counted.
/// @throws InputError if the design has no redundancy (with the smallest addition that would help) or the readings
///         do not fit the scenario's procedure at all.
DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                      const DiagnoseOptions& options = {});

}  // namespace diagnose
}  // namespace twinbench
