#include "twin/benches/rotary_4dof/twin/psd_noise.h"

#include <algorithm>
#include <cmath>

namespace twinbench::sim {
namespace {

constexpr double kCharge_C = 1.602176634e-19;
constexpr double kBoltzmann_J_K = 1.380649e-23;
constexpr double kRoom_K = 293.15;

}  // namespace

double PsdNoise_m(const PsdSettings& psd, double power_W, double length_m, double spot_m) {
  const double current_A = psd.responsivity_A_W * power_W;
  const double p = std::clamp(2.0 * spot_m / length_m, -1.0, 1.0);
  const double shot_A2_Hz = 2.0 * kCharge_C * (current_A * (1.0 - p * p) + psd.dark_current_A * (1.0 + p * p));
  const double thermal_A2_Hz = 8.0 * kBoltzmann_J_K * kRoom_K / psd.electrode_resistance_ohm * (1.0 + p * p);
  return 0.5 * length_m * std::sqrt(psd.bandwidth_Hz * (shot_A2_Hz + thermal_A2_Hz)) / current_A;
}

}  // namespace twinbench::sim
