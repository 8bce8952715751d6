#pragma once

#include <vector>

#include "twin/diagnose/compared.h"
#include "twin/diagnose/engine/asked_effects.h"
#include "twin/diagnose/engine/family.h"

/// What a diagnosis by the twin weighs against each other.
namespace twinbench::diagnose {

struct TwinCandidates {
  std::vector<Family> families;      // named ones first
  std::vector<Invisible> invisible;  // effects that the record shows nothing of
};

/// The record that causes are asked of. What they show is regressed on: with a reading's own noise in it, it would
/// explain that noise.
BelievedRecord AskedRecord(const Compared& compared, const std::vector<Reading>& readings, const Scenario& scenario,
                           const TwinComparison& comparison);

/// Effects of the catalogue, asked of the twin or as products, and structure without a name: on channels and at
/// points.
/// @param readings, scenario  Those that were compared; the scenario outlives the candidates.
TwinCandidates CandidatesOf(const Compared& compared, const std::vector<Reading>& readings,
                            const Scenario& scenario, const DiagnoseOptions& options,
                            const TwinComparison& comparison);

}  // namespace twinbench::diagnose
