#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "twin/core/estimator.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/diagnosis.h"
#include "twin/diagnose/engine/family.h"
#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/engine/noise_model.h"

/// What is asked of a diagnosis and what it answers: given readings and the scenario that is believed to describe
/// the bench, it finds what the model gets wrong, names it and measures what the extended model gains. Each bench
/// puts its own together from the parts of this room (Bench::diagnose).
namespace twinbench::diagnose {

struct DiagnoseOptions {
  Estimator model = Estimator::kRigorous;  // rotary bench: sensitivities that are believed
  std::vector<std::string> excluded;       // effects taken out of the catalogue (leave-one-cause-out tests)
  int null_runs = 500;                     // simulated runs without effect, for thresholds and p-values
  std::string cache_folder;                // calibrations are kept here by design; empty: nowhere
  /// Nothing is searched for: the answer says what readings of this design could tell (DiagnosisRun::isolability).
  bool design_only = false;
  int threads = 1;  // the answer is the same to the bit
};

struct Isolability;  // isolability.h

/// A cause in the model after the search, with its signature at the fitted shape.
struct Accepted {
  Family family;
  int grid_point = 0;
  Eigen::VectorXd shape;       // SI; at the grid point, or refined
  Eigen::VectorXd amplitudes;  // SI
  Eigen::MatrixXd columns;     // rows x amplitudes, SI, not whitened
  /// Structure without a name, where a row is the mean of several readings: its value at each reading, by number.
  std::vector<int> readings = {};
  Eigen::VectorXd times_s = {};
  Eigen::VectorXd at_readings = {};  // SI, on the first channel
};

/// All that the pages, the gain and the residual tests need besides the verdict.
struct DiagnosisRun {
  Diagnosis diagnosis;
  LinearRun run;
  NoiseModel noise;
  std::vector<Accepted> accepted;  // named causes and empirical terms, in order of acceptance
  double structure_p = kNaN;       // alarm_p without what single far values add to it
  double overtones = 0.0;          // probability that a wave it names repeats and is no sine
  /// Every named cause as if it were the only one, with its sizes, by its evidence alone against nothing; most probable
  /// first. They are no part of the answer; further runs are planned by them, and what is told is held against them.
  std::vector<Cause> suspects;
  /// Something was found: the named causes that are too unlikely for the answer to list, from a hundredth on. Each is
  /// indistinguishable from the first cause of its place.
  std::vector<Cause> less_likely;
  /// Instead of what has no name: named causes that explain it as well, but whose size and shape stand for each other - a
  /// tilt with a lag - so that these readings do not show that they are there. With the probability that they had if
  /// that were no matter.
  std::vector<Cause> unsized;
  std::shared_ptr<const Isolability> isolability;  // null unless `design_only` was asked for
};

}  // namespace twinbench::diagnose
