#pragma once

#include <string>
#include <utility>
#include <vector>

#include "twin/diagnose/engine/bent_waves.h"
#include "twin/diagnose/engine/null_calibration.h"
#include "twin/diagnose/engine/scanner.h"

namespace twinbench::diagnose {

/// One cause that the search holds responsible.
struct Term {
  int family = 0;
  int grid_point = 0;
  Eigen::VectorXd shape;          // refined; empty without shapes
  Eigen::MatrixXd columns;        // signature at that shape: rows x amplitudes, not whitened
  Eigen::VectorXd log_posterior;  // of every family in this place, the others accepted; last: none
  /// The same with the named families whose size is not known, for it and their shape stand for each other: they come
  /// behind what has no name. Empty: none does.
  Eigen::VectorXd log_with_unsized = {};
  double statistic = 0.0;         // alarm statistic in this place, the others accepted
  double explained = 0.0;         // of the whitened power, beyond what the other terms explain
  Eigen::VectorXd amplitudes;     // fitted together with those of the other terms, SI
  Eigen::MatrixXd cov;            // of the amplitudes and the shape parameters after them
  std::vector<std::pair<std::string, std::string>> unlike = {};  // causes of the place that show nothing of it (unlike.h)
};

struct SearchResult {
  std::vector<Term> terms;
  double first_statistic = 0.0;  // alarm statistic of the whole run
  double last_statistic = 0.0;   // of what remains
  double joint_evidence = 0.0;   // of all terms together: each given those before it
  double rest_of_bend = 0.0;     // see BentWaves
  double overtones = 0.0;        // probability that a named wave repeats and is no sine (overtones.h)
  Evidence alone;                // the first scan
};

/// How far a search goes.
struct SearchExtent {
  int most_causes;
  int most_orders = 0;  // causes where all that are found are whole orders, if that is more: what there is no room for
                        // would look like noise that remembers itself
  /// Only the first cause with a name is wanted, and what it stands behind: the largest first, and of what explains nearly
  /// as much the one that has a name. As long as much is not explained, shapes without one follow parts of it. Nothing is
  /// selected again.
  bool largest_only = false;
  BentWaves bent = {};
  bool together = false;  // causes without a shape are tried together as well: see together.h
};

/// Finds simultaneous causes: scan, take the most probable, refine its shape, scan what
/// remains; then select every term again with the others accepted (swaps), and drop those that are not
/// needed any more.
SearchResult Search(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                    const Scanner& scanner, const Eigen::VectorXd& log_priors, double threshold,
                    const SearchExtent& extent);

}  // namespace twinbench::diagnose
