#include "twin/separate/index_errors.h"

#include <cmath>

#include "twin/benches/encoder_comparison/bench.h"
#include "twin/benches/encoder_comparison/estimators/device_error.h"
#include "twin/core/errors.h"

namespace twinbench::benches::encoder {

separate::IndexErrors IndexErrorsOf(const Scenario& scenario, const std::vector<Reading>& readings) {
  const separate::encoder::DeviceError device =
      separate::encoder::SeparateDevice(readings, DeviceOptionsOf(EncoderOf(scenario)));
  if (device.highest_order == 0) throw InputError("readings", device.not_separated, "readings over a whole turn");
  std::vector<separate::IndexReading> values;
  double squares_rad2 = 0.0;
  int known = 0;
  for (std::size_t i = 0; i < device.both.position_rad.size(); ++i) {
    // An axis that is driven to where its device shows an angle has not gone as far as the device shows too much.
    values.push_back({0, device.both.position_rad[i], -device.both.value_rad[i]});
    if (!(device.both.u_rad[i] > 0.0)) continue;
    squares_rad2 += device.both.u_rad[i] * device.both.u_rad[i];
    ++known;
  }
  separate::IndexErrors errors = separate::MeansByPlace(values);
  if (known > 0) {
    errors.u_reading_rad = std::sqrt(squares_rad2 / known);  // of the mean at a place
    errors.dof = known;                                      // one for each mean: at least two readings
  }
  for (const separate::harmonics::Coefficient& c : device.curves.device.orders)
    errors.u_order_rad.push_back(separate::harmonics::LargestUncertainty(c));
  errors.reversal_rad = -device.reversal.value_rad;
  errors.u_reversal_rad = device.reversal.u_rad;
  errors.table = "device";
  return errors;
}

}  // namespace twinbench::benches::encoder
