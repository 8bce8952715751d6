#include "twin/benches/encoder_comparison/twin/graduation.h"

#include <cmath>

#include "twin/benches/encoder_comparison/settings.h"
#include "twin/core/stream.h"

namespace twinbench::sim {

Graduation::Graduation(const Scenario& scenario) {
  const DeviceSettings& device = EncoderOf(scenario).device;
  if (device.graduation_rad == 0.0) return;
  Stream stream(scenario.seed, "device.graduation");
  double sum2 = 0.0;
  for (int k = 1; k <= device.graduation_orders; ++k) {
    const double size = std::pow(k, -device.graduation_fall), cosine = stream.Normal(), sine = stream.Normal();
    order_rad_.emplace_back(size * cosine, -size * sine);
    sum2 += size * size;
  }
  for (std::complex<double>& c : order_rad_) c *= device.graduation_rad / std::sqrt(sum2);
}

double Graduation::Error_rad(double device_rad) const {
  const std::complex<double> turn = std::polar(1.0, device_rad);
  std::complex<double> sum = 0.0;
  for (auto c = order_rad_.rbegin(); c != order_rad_.rend(); ++c) sum = (sum + *c) * turn;  // Horner
  return sum.real();
}

}  // namespace twinbench::sim
