#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "twin/core/scenario.h"
#include "twin/diagnose/engine/linear_run.h"

/// What causes do to the readings of a turntable that is checked with a multi-tooth table and an autocollimator,
/// written here a second time: the twin's own code is not asked. A signal has one entry a used reading, in rad of
/// an autocollimator's axis unless its name says otherwise.
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

/// The instrument as it is believed to be, with the [[effect]] blocks that change it.
struct Instrument {
  double roll_rad = 0.0;
  double gain_error = 0.0;
  double sag_m = 0.0;
};
Instrument BelievedInstrument(const Scenario& scenario);

/// What the scenario predicts of each reading without any unknown: steps of the sweep, gap of the turntable, beam
/// walk, stated temperature coefficients, [[effect]] and [[empirical]] blocks. Single outliers are not foreseen:
/// zero.
///
/// @param shown_rad  Readings x axes: what the optics show, on which cubic errors and ripples depend.
/// @param sweep_rad  Steps of the sweep; zero outside of it.
/// How much of a small change of what the optics show is added behind them: readings x axes.
Eigen::MatrixXd SlopesOfReading(const Eigen::MatrixXd& shown_rad, const Scenario& scenario,
                                const SignalContext& context);

struct KnownSignals {
  Eigen::MatrixXd of_optics_rad;  // steps, gap, beam walk
  Eigen::MatrixXd behind_rad;     // moves of the zero, errors that depend on the reading
};
/// How far the zeros of both axes go with the temperature, by coefficients and [[effect]] blocks [rad/K].
Eigen::Vector2d ZeroPerKelvin_rad(const Scenario& scenario);
/// True of an effect that is added behind the optics: a moving zero, a ripple.
bool IsAddedBehind(const EffectSettings& effect);
/// True if any of it depends on `shown_rad`.
bool DependsOnReading(const Scenario& scenario);
KnownSignals KnownSignalsOf(const Eigen::MatrixXd& shown_rad, const Eigen::VectorXd& sweep_rad,
                            const Scenario& scenario, const SignalContext& context);

}  // namespace twinbench::diagnose::turntable
