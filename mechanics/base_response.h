#pragma once

#include <complex>

#include "mechanics/stack.h"

/// How the stack answers to a base that shakes.
namespace twinbench::mechanics {

using ComplexResponse = Eigen::Matrix<std::complex<double>, kCoordinates, 3>;

/// The steady answer to one frequency, both servos holding their position.
///
/// Laser and detectors stand on the base. Seen from there every mass is pulled by minus its mass times the base's
/// acceleration, so that with p = i omega
///
///   (p^2 M + p D + K + servo) y = -M e_k a,   servo = (Kp + Kd p + Ki / p) on the rotors' angles,
///
/// e_k one metre along axis k. For a single mass this is the relative transmissibility r^2 / (1 - r^2 + 2 i zeta r)
/// of the base's amplitude, r = f / f0 (Harris' Shock and Vibration Handbook, chapter 2).
///
/// @param frequency_Hz  Positive.
/// @return amplitudes [m, rad] of the twelve coordinates in the payload's axes (see StackPropagator) for a base
/// that
///         accelerates by 1 m/s^2 along x, y, z of these axes: one column each.
ComplexResponse RespondToBase(const StackParameters& parameters, double frequency_Hz);

}  // namespace twinbench::mechanics
