#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "twin/core/run_record.h"
#include "twin/report/page/figure.h"

namespace twinbench::report {

/// Where what is shown came from.
struct PageSource {
  std::string name;             // of the run
  std::string title = {};       // of its scenario
  Provenance provenance = {};
  std::string program_version;  // that made the page
  std::vector<std::pair<std::string, std::string>> digests;  // file, SHA-256
};

/// A run: its causes if there is a diagnosis, errors (values where there are no curves), residuals, spectra, values, budget, what is not separable, provenance.
///
/// @param results  results.json.
/// @param score    score.json; null if the run was not scored. The only place that truth is taken from.
/// @param readings Of its record.
/// @param images   Of the light, where it was pictured.
Page RunPage(const PageSource& source, const nlohmann::json& results, const nlohmann::json& score, const std::vector<Reading>& readings = {},
             const std::vector<PageImage>& images = {});

/// Versions, seed, digests.
PageSection ProvenanceSection(const PageSource& source);

}  // namespace twinbench::report
