#pragma once

#include "twin/benches/rotary_4dof/settings.h"

namespace twinbench::sim {

/// Noise of one sample of the place that a duo-lateral PSD tells along one axis, standard deviation [m].
///
/// Two electrodes share the photocurrent I = responsivity x power in proportion to the place u, and the read-out is
/// (L / 2) (I_a - I_b) / (I_a + I_b), L the length of the axis. With p = 2 u / L, shot noise 2 q B of each current
/// (its half of dark current and background included) and thermal noise 4 k T B / R of the resistance R between the
/// electrodes, to first order
///
///     var(u) = (L / 2)^2 B / I^2 [ 2 q (I (1 - p^2) + I_dark (1 + p^2)) + 8 k T / R (1 + p^2) ].
///
/// Where the light's shot noise leads it falls as 1 / sqrt(power), in the dark as 1 / power.
///
/// @param power_W   Light on the detector, positive.
/// @param length_m  Of the axis.
double PsdNoise_m(const PsdSettings& psd, double power_W, double length_m, double spot_m);

/// What noise of the laser's intensity does to that place in one sample [m]; signed, for all channels by the same
/// draw.
///
/// A relative change of the power leaves (I_a - I_b) / (I_a + I_b) as it is, to first order and beyond. A
/// background I_bg that counts as signal and belongs to the middle makes it u I / (I + I_bg), which moves with the
/// power:
///
///     standard deviation = u_shown I_bg / (I + I_bg) sqrt(10^(RIN / 10) B).
///
/// @param rin_dB_Hz  One-sided; 0: none. @param spot_m  As shown, background included.
double IntensityNoise_m(const PsdSettings& psd, double rin_dB_Hz, double power_W, double spot_m);

}  // namespace twinbench::sim
