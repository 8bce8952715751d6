#pragma once

#include "twin/benches/rotary_4dof/settings.h"

namespace twinbench::sim {

/// Noise of one sample of the place that a duo-lateral PSD tells along one axis, standard deviation [m].
///
/// Two electrodes share the photocurrent I = responsivity x power in proportion to the place u, and the read-out is
/// (L / 2) (I_a - I_b) / (I_a + I_b), L the length of the axis. With p = 2 u / L, shot noise 2 q B of each current
/// (its half of the dark current included) and thermal noise 4 k T B / R of the resistance R between the
/// electrodes, to first order
///
///     var(u) = (L / 2)^2 B / I^2 [ 2 q (I (1 - p^2) + I_dark (1 + p^2)) + 8 k T / R (1 + p^2) ].
///
/// Where the light's shot noise leads it falls as 1 / sqrt(power), in the dark as 1 / power.
///
/// @param power_W   Light on the detector, positive.
/// @param length_m  Of the axis.
double PsdNoise_m(const PsdSettings& psd, double power_W, double length_m, double spot_m);

}  // namespace twinbench::sim
