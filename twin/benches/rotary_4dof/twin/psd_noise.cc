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
  const double dark_A = psd.dark_current_A + psd.background_A;
  const double p = std::clamp(2.0 * spot_m / length_m, -1.0, 1.0);
  const double shot_A2_Hz = 2.0 * kCharge_C * (current_A * (1.0 - p * p) + dark_A * (1.0 + p * p));
  const double thermal_A2_Hz = 8.0 * kBoltzmann_J_K * kRoom_K / psd.electrode_resistance_ohm * (1.0 + p * p);
  return 0.5 * length_m * std::sqrt(psd.bandwidth_Hz * (shot_A2_Hz + thermal_A2_Hz)) /
         (current_A + psd.background_A);
}

double IntensityNoise_m(const PsdSettings& psd, double rin_dB_Hz, double power_W, double spot_m) {
  if (rin_dB_Hz == 0.0) return 0.0;
  const double current_A = psd.responsivity_A_W * power_W;
  const double relative = std::sqrt(std::pow(10.0, rin_dB_Hz / 10.0) * psd.bandwidth_Hz);
  return spot_m * psd.background_A / (current_A + psd.background_A) * relative;
}

}  // namespace twinbench::sim
