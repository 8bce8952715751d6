#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "twin/core/scenario.h"
#include "twin/diagnose/engine/linear_run.h"

/// What causes depend on at a turntable that is checked with a multi-tooth table and an autocollimator. A signal
/// has one entry a used reading, in rad of an autocollimator's axis unless its name says otherwise.
namespace twinbench::diagnose::turntable {

enum Axis { kX, kY };
inline constexpr int kAxes = 2;
inline constexpr std::array<const char*, kAxes> kAxisNames = {"x", "y"};

/// The circumstances that signals depend on.
struct SignalContext {
  Schedule schedule;
  Eigen::VectorXd since_mounting_s;  // of the set-up: what its first stop took before the first reading
  Eigen::VectorXd above_K;           // against environment.reference_degC; empty if it was never recorded
  Eigen::VectorXd beam_walk_m;       // how far the mirror's middle stands aside of the beam
  Eigen::MatrixXd shown_rad;         // readings x axes, as predicted: without their own noise, and without what the
                                     // scenario knows to be added behind the optics
  double range_rad = 0.0;            // of the autocollimator
  double pixel_rad = 0.0;            // turn of the mirror that moves the image by a pixel
  double mirror_width_m = 0.0;
  Eigen::VectorXd since_arrival_s;  // end of the turntable's move -> reading; without a dwell NaN

  Eigen::Index Readings() const { return schedule.time_s.size(); }
  bool HasTemperature() const { return above_K.size() > 0; }
  bool HasDwell() const { return schedule.dwell_s.array().isFinite().any(); }
};

/// All but `shown_rad`. Readings without a temperature keep the one before.
SignalContext ContextOf(const Schedule& schedule, const Scenario& scenario);

/// ln(1 + time since mounting / time constant).
Eigen::VectorXd CreepSignal(const SignalContext& context, double time_constant_s);

/// Recorded direction of the turntable, +1 or -1.
Eigen::VectorXd DirectionSignal(const SignalContext& context);

/// A gap of unit width: the turntable stays behind on the side that it came from. Of x.
Eigen::VectorXd BacklashSignal(const SignalContext& context);

/// Behind by one at the end of the move. Of x.
Eigen::VectorXd SettlingSignal(const SignalContext& context, double time_constant_s);

/// Slope of a mirror of unit sag over its width where the beam meets it, 8 dL / H^2 [1/m]. Of x.
Eigen::VectorXd FlatnessSignal_per_m(const SignalContext& context);

/// The cube of both readings in units of the range: readings x axes.
/// @param radial  Each axis times the square of the distance from the middle, as a distorting lens does it; else
///                each axis for itself.
Eigen::MatrixXd CubicSignals(const Eigen::MatrixXd& shown_rad, double range_rad, bool radial);

/// Readings x axes, one signal, as rows.
Eigen::VectorXd AsRows(const Eigen::MatrixXd& of_axes);

}  // namespace twinbench::diagnose::turntable
