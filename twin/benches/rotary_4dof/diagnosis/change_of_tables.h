#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/core/table_errors.h"
#include "twin/diagnose/diagnose.h"

/// What a model with the accepted causes changes in the separated errors.
namespace twinbench::diagnose::rotary {

/// By how much the accepted causes move the separated errors of a rotary bench, rms over the positions [rad, m].
/// Components that nobody reads are NaN. What cannot be separated stays zero in both and does not count.
struct ChangeOfUnknowns {
  std::array<double, kComponents> target_rms, reference_rms;  // by Component
};

/// @param positions  n; the unknowns begin with the 9 n table errors in the order of separate::Design::Column.
ChangeOfUnknowns ChangeOfTables(const LinearRun& run, const NoiseModel& noise,
                                const std::vector<Accepted>& accepted, int positions);

/// `gain.change_of_tables`: {"target": {"ex_arcsec": rms, ...}, "reference": {...}}; components that nobody reads
/// are left out.
nlohmann::json ToJson(const ChangeOfUnknowns& change);

}  // namespace twinbench::diagnose::rotary
