#pragma once

#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/rotary/known_effects.h"
#include "twin/diagnose/rotary/optical_bench.h"
#include "twin/model/follow.h"
#include "twin/separate/design.h"

/// The forward model of the rotary bench as a function: scenario and schedule -> what every reading should show,
/// and the directions in which the free unknowns may move it.
namespace twinbench::diagnose::rotary {

struct RotaryRun {
  LinearRun run;
  OpticalBench bench;
  separate::Design design;
  std::vector<Vector4> motion;      // fitted, one a used reading
  Eigen::Matrix4d shown_by_motion;  // d shown / d motion at rest
  std::vector<int> shifts;          // of the set-ups, in steps
  std::vector<int> scanned_before;  // of each channel, the one that is converted just before it
  double sample_noise_V = 0.0;      // of one A/D sample
  int left_out = 0;
};

/// What readings are compared with.
struct ForwardModel {
  bool published = false;     // equations 1-12 of Jywe et al. (2007)
  model::FollowMaker follow;  // else the twin that follows the record; empty: the closed forms of optical_bench.h
};

/// Fits table errors and mounting constants to the readings (Gauss-Newton on the exact chain and grating equation)
/// and linearises there. Effects that the scenario already holds are part of the model.
///
/// Unknowns and their priors: free_parameters.h. Noise: the blocks' standard deviations pooled by channel, else
/// what the scenario states.
///
/// @throws InputError if the commanded angles are on no grid or hardly any reading is usable.
RotaryRun BuildRun(const std::vector<Reading>& readings, const Scenario& scenario, const ForwardModel& model = {});

/// What additive effects need to know about the run; keeps references into it.
/// @param shown_m  What the channels show, by row, for effects that depend on it: the prediction, or the readings.
SignalContext ContextOf(const RotaryRun& rotary, const Scenario& scenario, const Eigen::VectorXd& shown_m);

}  // namespace twinbench::diagnose::rotary
