#pragma once

#include "twin/core/reading.h"
#include "twin/separate/series.h"

namespace twinbench::separate::harmonics {

enum class PositionStatus { kOk, kNoTurn };  // kNoTurn: no turn was complete enough
enum class ScatterSource { kBetweenTurns, kWithinTurn };

/// Of the turn of a shaft that the table is geared to.
struct HobOrder {
  int times = 0;     // per turn of that shaft
  Coefficient wave;  // by its angle
  double dof = kNaN;
};

/// Mean over the turns of one set-up in one direction.
struct PositionError {
  int setup = 0;
  int direction = 1;
  double head_rad = kNaN;
  PositionStatus status = PositionStatus::kNoTurn;
  HarmonicSeries series;                                 // covariance of the mean; empty with kNoTurn
  ScatterSource scatter = ScatterSource::kBetweenTurns;  // where the covariance is from
  int turns = 0;
  int turns_left_out = 0;            // incomplete, or with gaps too wide
  int samples = 0;                   // used
  double residual_rms_rad = kNaN;    // of a sample about its own turn's fit: noise, and orders above max_order
  double drift_rad_per_turn = kNaN;  // in the direction of travel; NaN if no pass has three turns
  double u_drift_rad_per_turn = kNaN;
  std::vector<double> of_drift_rad2 = {};  // [k - 1]: of the variance of either part of order k, what that leaves
  std::vector<double> of_rounding_rad2 = {};  // likewise, what the steps of counts repeat in every turn; empty: nothing
  std::vector<HobOrder> of_hob = {};  // that are no orders of the table's turn which are fitted
  double of_folding_rad2 = 0.0;  // of that variance of every order, what orders above them fold onto them
};

}  // namespace twinbench::separate::harmonics
