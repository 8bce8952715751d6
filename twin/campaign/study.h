#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "twin/campaign/variation.h"
#include "twin/core/estimator.h"
#include "twin/core/scenario.h"

namespace twinbench::campaign {

enum class Sampling { kRandom, kLatinHypercube };

/// Many runs of one scenario: a study file (docs/campaign.md).
struct Study {
  std::string text;              // of the file
  std::string scenario_name;     // of the base scenario's file, or of the study that holds it
  std::string scenario_text;     // of the base scenario
  std::string scenario_folder;   // from which the base scenario names files
  std::vector<std::string> set;  // "procedure.positions=12", in every trial
  std::uint64_t seed = 1;
  int trials = 1;  // at every point of the grids
  Sampling sampling = Sampling::kRandom;
  Estimator estimator = Estimator::kRigorous;
  bool diagnosis = false;  // also keep its verdict
  /// The twin has every u_<key> of the scenario drawn, evaluation believes what is written, and what is compared with the
  /// truth has its combined uncertainty (uncertainty::Budgets) instead of what the readings alone leave.
  bool standards = false;
  std::vector<Variation> vary;

  /// The base scenario with these keys put in.
  Scenario With(const std::vector<std::string>& overrides) const;
};

/// @throws InputError with file:line for a syntax error, an unknown or missing key, a wrong type or value, and for
/// a
///         varied key that the base scenario's bench does not have or that refuses the values it would be given.
Study ParseStudy(const std::string& text, const std::string& name, const std::string& folder);
Study LoadStudy(const std::string& path);

}  // namespace twinbench::campaign
