#pragma once

#include <memory>
#include <string>
#include <vector>

#include "twin/diagnose/engine/naming.h"
#include "twin/diagnose/engine/noise_causes.h"
#include "twin/diagnose/engine/search.h"

namespace twinbench::diagnose {

struct AnalysisOptions {
  int null_runs = 500;
  std::string cache_folder;
  int most_causes = 4;
  const NullCalibration* null = nullptr;  // of a design that is the same but for its unknowns; else simulated
  bool design_only = false;               // no search
  bool largest_only = false;              // the first large cause with a name, to be asked about: see Search
  int most_orders = 0;                    // see SearchExtent
  BentWaves bent = {};                    // likewise
  bool together = false;                  // likewise
  int threads = 1;
};

/// A run searched with a noise model that its own residuals do not refute.
struct Analysis {
  NoiseModel noise;
  std::unique_ptr<Projector> projector;
  Eigen::VectorXd redundancy;  // of every row
  std::unique_ptr<Scanner> scanner;
  NullCalibration null;
  double threshold = 0.0;
  bool design_only = false;
  SearchResult found;  // nothing if `design_only`
  double power = 0.0;                    // y'Wy before any cause
  std::vector<NoiseCause> repairs;       // in order
  std::vector<NoiseCause> observations;  // noted only: nothing was chosen on this noise model
};

/// Searches; where the noise alone explains more than what was picked, or what remains is no longer white, repairs
/// the noise model and searches again, at most four times.
/// @param run, families  Must outlive the analysis.
Analysis Analyse(const LinearRun& run, const std::vector<Family>& families, const AnalysisOptions& options);

}  // namespace twinbench::diagnose
