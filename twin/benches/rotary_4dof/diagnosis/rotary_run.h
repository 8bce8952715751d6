#pragma once

#include <memory>
#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/diagnosis/rotary_twin.h"
#include "twin/benches/rotary_4dof/estimators/design.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/engine/linear_run.h"

/// The forward model of the rotary bench as a function: scenario and schedule -> what every reading should show,
/// and the directions in which the free unknowns may move it.
namespace twinbench::diagnose::rotary {

/// How the channels respond to a point of the twin: by a pattern [m per SI], of which every reading shows a share.
/// It is one but where the twin knows better: of a turn of the grating that the autocollimator sees, the sweep
/// shows nothing.
struct Response {
  Vector4 pattern;
  Eigen::VectorXd share;  // one a used reading
};

struct RotaryRun {
  LinearRun run;
  measure::BenchGeometry geometry;
  bool published = false;
  separate::Design design;
  std::shared_ptr<const RotaryTwin> twin;
  std::vector<Vector4> motion;      // fitted, one a used reading
  std::vector<Vector4> free;        // the same as the twin is asked with it
  Eigen::Matrix4d shown_by_motion;  // patterns of yaw, tilt, roll, lateral of the grating
  double sample_noise_V = 0.0;      // of one A/D sample
  int left_out = 0;

  Response ResponseTo(const std::string& point) const;
};

/// What readings are compared with.
struct ForwardModel {
  model::FollowMaker follow;  // the twin that follows the record
  bool published = false;     // of its light only equations 1-12 of Jywe et al. (2007) are believed
};

/// Fits table errors and mounting constants to the readings (Gauss-Newton with slopes of the twin) and linearises
/// there. Effects that the scenario already holds are part of the model.
///
/// Unknowns and their priors: free_parameters.h. Noise: the blocks' standard deviations pooled by channel, else
/// what the scenario states.
///
/// @throws InputError if the commanded angles are on no grid, hardly any reading is usable, or the twin would show
/// nothing where a reading has a value.
RotaryRun BuildRun(const std::vector<Reading>& readings, const Scenario& scenario, const ForwardModel& model);

}  // namespace twinbench::diagnose::rotary
