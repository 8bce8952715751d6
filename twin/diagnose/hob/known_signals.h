#pragma once

#include "twin/diagnose/hob/signals.h"

/// What the scenario says of its machine, and the causes that it knows already.
namespace twinbench::diagnose::hob {

/// A signal by sample [rad]: in m of the encoders, and in what the interferometer saw.
struct SampleSignal {
  Eigen::VectorXd encoders_rad;
  Eigen::VectorXd interferometer_rad;

  SampleSignal& operator+=(const SampleSignal& other);
};

/// Stated transmission error, wind-up, backlash, lag and ring errors. Rings to first order of eccentricity, tilt
/// and ellipticity over the radius: a micrometre and an arcsecond matter, their squares do not.
SampleSignal StatedSignal(const Scenario& scenario, const SignalContext& context);

/// The whole signal of an [[effect]] block. Single outliers are not foreseen: zero. Drift and tone are taken as
/// motions of the table.
SampleSignal EffectSignal(const EffectSettings& effect, const SignalContext& context);

/// All of it, with [[effect]] and [[empirical]] blocks.
SampleSignal KnownSignal(const Scenario& scenario, const SignalContext& context);

}  // namespace twinbench::diagnose::hob
