#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "twin/core/scenario.h"
#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/rotary/optical_bench.h"

/// What each effect of the catalogue does to the readings, written here a second time: the twin's own code is not
/// asked. An effect either alters the optical bench or adds a signal to the channels.
namespace twinbench::diagnose::rotary {

/// Effect parameters in SI, by their name in the catalogue.
using Parameters = std::map<std::string, double>;

/// True for causes that are a wrong property of the optics or detectors.
bool AltersBench(const std::string& effect);

/// Alters the bench as the effect says.
/// @param above_K  Room temperature above the scenario's reference.
void AlterBench(const std::string& effect, const std::string& where, const Parameters& parameters, double above_K,
                OpticalBench& bench);

/// The bench with all effects of the scenario that alter it.
OpticalBench WithKnownEffects(OpticalBench bench, const Scenario& scenario, double above_K);

/// What the additive effects need to know about a run.
struct SignalContext {
  const LinearRun& run;
  Eigen::Matrix4d shown_by_motion;             // d shown / d [ez, ex, ey, dy] at rest
  Eigen::Matrix<double, 4, 2> shown_by_laser;  // d shown / d laser yaw, pitch
  double target_height_m = 0.13;               // spot above the target table's origin
  double reference_degC = 20.0;
  std::array<double, 2> sensitivity_V_m{};
  std::vector<int> scanned_before;  // of each channel, the one converted just before
  Eigen::VectorXd shown_m;          // what the channels show, by row
  double sample_noise_V = 0.0;      // standard deviation of one A/D sample
  double settle_s = 0.0;            // in-position window of the tables: from a move's end to the dwell's beginning
  Eigen::Vector4d shown_by_wavelength = Eigen::Vector4d::Zero();  // d shown / d wavelength at rest
};

/// Signal of an additive effect at unit amplitude, rows x amplitudes (SI per SI).
///
/// Amplitudes: laser_drift drift; mount_creep amplitude; thermal_tilt tilt_per_kelvin; backlash half_width;
/// settling amplitude; bearing_half_frequency tilt x (cos, sin); tone amplitude x (cos, sin) of its phase; slip
/// angle or shift; adc_step step, smoothed by the samples' noise; crosstalk fraction.
Eigen::MatrixXd EffectSignal(const std::string& effect, const std::string& where, const Parameters& shape,
                             const SignalContext& context);

/// How a bearing's motion goes about: whether turns are counted through all set-ups, height of the spot above the
/// point that it tilts about, and whether it whirls with the angle (+1) or against it (-1).
struct Whirling {
  bool through_setups = false;
  double lever_m = 0.0;
  double sense = 1.0;
};

/// Bearing motion once in about two turns: tilt x (cos, sin) of its phase, rows x 2.
Eigen::MatrixXd HalfFrequencySignal(double order, const Whirling& whirling, const SignalContext& context);

/// A step in a channel's A/D: the share of a block's samples above it, per sensitivity [m / V], rows x 1.
Eigen::MatrixXd AdcStepSignal(int channel, double at_V, double blur_V, const SignalContext& context);

/// What each channel keeps of the one converted before it, at unit fraction, rows x 1.
Eigen::VectorXd CrosstalkRows(int channel, const SignalContext& context);

/// Weight of a place on the channels: "yaw", "tilt", "roll", "lateral" of the grating, a channel, a PSD.
Eigen::Vector4d WeightOf(const std::string& where, const Eigen::Matrix4d& shown_by_motion);

/// All additive effects that the scenario already holds, by row [m].
Eigen::VectorXd KnownSignal(const Scenario& scenario, const SignalContext& context);

}  // namespace twinbench::diagnose::rotary
