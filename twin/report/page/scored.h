#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/report/evaluation.h"

/// What `score` writes for every result beside its truth, and how a page finds it again.
namespace twinbench::report {

/// `values` of score.json: { "target.ez_arcsec": { "value": [...], "u": [...], "truth": [...] } }, a list for
/// "target.ez_arcsec[0]", "target.ez_arcsec[1]", ...; one that has no index is a list of one.
nlohmann::json ScoredValuesJson(const std::vector<ScoredValue>& values);

/// The truth of a list of results.json, as the score compares it: without what the design cannot tell.
/// @param path  "separation.target.ez_arcsec"; the score may leave out how it begins.
/// @return as many numbers as `size`, or none.
std::vector<double> TruthOf(const nlohmann::json& score, const std::string& path, std::size_t size);

}  // namespace twinbench::report
