#include "hw_bridge/numbers/number_source.h"

#include <fmt/format.h>

#include "hw_bridge/ad/ad_source.h"
#include "twin/core/errors.h"
#ifdef TWINBENCH_WITH_IIO
#include "hw_bridge/numbers/number_drivers.h"
#endif
#ifdef TWINBENCH_WITH_COMEDI
#endif
#ifdef TWINBENCH_WITH_MODBUS
#endif

namespace twinbench::hw {

bool HasNumberDriver(const std::string& kind) {
#ifdef TWINBENCH_WITH_MODBUS
  if (kind == "modbus") return true;
#endif
  return HasAdDriver(kind);
}

std::unique_ptr<NumberSource> MakeNumberSource(const NumberSettings& settings, const std::string& device,
                                               const std::string& where) {
#ifdef TWINBENCH_WITH_IIO
  if (settings.kind == "iio") return MakeIioNumbers(settings, device, where);
#endif
#ifdef TWINBENCH_WITH_COMEDI
  if (settings.kind == "comedi") return MakeComediNumbers(settings, device, where);
#endif
#ifdef TWINBENCH_WITH_MODBUS
  if (settings.kind == "modbus") return MakeModbusNumbers(settings, device, where);
#endif
  throw InputError(where, fmt::format("this build was made without the driver \"{}\"", settings.kind),
                   "another kind");
}

std::string NumberItemForm(const std::string& kind) {
  if (kind == "modbus")
    return "\"holding 100 int32\": holding or input, register, int16, uint16, int32, uint32 or float32; \"low\" "
           "behind it where the low word comes first";
  if (kind == "iio") return "\"count0 raw\": channel and attribute, or an attribute of the device";
  return "\"5 0 signed\": subdevice and channel; \"signed\" where a counter goes below zero";
}

}  // namespace twinbench::hw
