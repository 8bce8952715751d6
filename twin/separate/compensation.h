#pragma once

#include <vector>

#include "twin/core/compensation_table.h"
#include "twin/separate/line_search.h"

/// From the index errors of a table to what its controller should add, and what will be left.
namespace twinbench::separate {

struct CompensationOptions {
  LineSearchOptions search = {};
  int points = 0;  // of the table; 0: as many as the highest order needs
};

enum class LineFate {
  kCompensated,
  kAliased,  // the places that were read do not say which order it is: refused
  kTooFine,  // a table of so few entries would leave more than half of it: refused
  kChanging,  // it differs between turns by as much as it is: refused
  kNoGain    // all together would leave no less than there was: refused
};

struct CompensatedLine {
  IndexLine line;
  LineFate fate = LineFate::kAliased;
};

/// Sizes of the index error at the places that were read, root mean squares about their mean.
struct RemainingError {
  double before_rms_rad = kNaN;
  double predicted_rms_rad = kNaN;  // of the same measurement with the table at work
  double u_predicted_rms_rad = kNaN;
  // Parts of the prediction; what they leave of it is the table's and the reference's errors without a line.
  double refused_rms_rad = 0.0;
  double noise_rms_rad = kNaN;  // of the mean of a place's readings; NaN if none was read twice
};

struct Compensation {
  LineFit fit;
  std::vector<CompensatedLine> lines;  // by order
  CompensationTable table;             // with what was commanded before; zero where nothing helps
  RemainingError remaining;

  /// Lines of this fate.
  std::vector<int> Orders(LineFate fate) const;
  bool IsAliased() const { return !Orders(LineFate::kAliased).empty() || !fit.unseen.empty(); }
};

/// Compensates the lines whose order is certain and that a table of so many entries can follow. A table that would
/// leave more than there was before is not given: its corrections are zero.
///
/// Prediction: squares of what the table leaves of the values that were read, less the share that the fit has taken
/// of their noise, plus the noise of its coefficients: E r'^2 = r^2 + 2 H_ii s_i^2 for the same readings again,
/// with H the fit's matrix and s_i the noise of the mean at place i. Nothing is said about orders above the highest
/// that was looked for, nor about what changes between the two measurements.
/// @throws InputError as FindLines; if points are fewer than 8.
Compensation Compensate(const IndexErrors& errors, const CompensationOptions& options = {});

/// Part of the amplitude of an order that a table of even entries leaves, root mean square over the angle: straight
/// lines instead of a wave.
double LeftByInterpolation(int order, int points);

/// What a measurement with the table at work shows, against what was predicted.
struct CompensationCheck {
  int places = 0;
  double before_rms_rad = kNaN;     // at these places, or at all if they are others
  double predicted_rms_rad = kNaN;  // for the places and the number of readings of the check
  double remeasured_rms_rad = kNaN;
  double Ratio() const { return predicted_rms_rad / remeasured_rms_rad; }
  double u_ratio = kNaN;  // of the ratio, from the number of places: both are estimates
  bool IsBetter() const { return remeasured_rms_rad <= before_rms_rad; }
};

/// @throws InputError if `again` was not read with the table of the compensation at work.
CompensationCheck CheckCompensation(const IndexErrors& first, const Compensation& compensation,
                                    const IndexErrors& again);

}  // namespace twinbench::separate
