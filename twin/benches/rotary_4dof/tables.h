#pragma once

#include <string>

#include "twin/benches/rotary_4dof/analysis.h"
#include "twin/report/evaluation.h"

namespace twinbench::benches::rotary {

/// What a run found, as text for a person: counts, stability, verification, and each table's errors with their
/// uncertainties and what cannot be separated.
std::string Summary(const Analysis& analysis);

/// One component of one table against the truth, with what cannot be separated taken out of both.
struct ComponentScore {
  std::string table;  // "target", "reference"
  Component component{};
  int positions = 0;  // compared
  double rms_truth = kNaN;
  double rms_error = kNaN;
  double worst_error = kNaN;
  double rms_u = kNaN;
  double mean_chi2 = kNaN;  // (error / u)^2, 1 if the uncertainties are right; correlated over positions
  std::vector<double> truth, estimate, u;
};

struct Score {
  std::vector<ComponentScore> components;
  TableErrors target_truth, reference_truth;  // what is separable of it
};

Score CompareWithTruth(const separate::Separation& separation, const TableErrors& target,
                       const TableErrors& reference);

std::string ScoreTable(const Score& score);
/// One row a position: estimate, uncertainty and truth of every component.
std::string PositionTable(const Score& score, const separate::Separation& separation);
nlohmann::json ToJson(const Score& score);
/// Every component at every position.
std::vector<report::ScoredValue> ValuesOf(const Score& score);

}  // namespace twinbench::benches::rotary
