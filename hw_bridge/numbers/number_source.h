#pragma once

#include <memory>
#include <string>
#include <vector>

#include "twin/core/time.h"

/// Instruments that are numbers in a card or behind a gateway: counters, registers, attributes of a driver.
namespace twinbench::hw {

/// Where some numbers are read, and which.
struct NumberSettings {
  std::string kind;                // modbus | iio | comedi
  std::string address;             // modbus: "tcp:HOST:PORT", or "serial:..." for RTU
  int unit = 1;                    // modbus: of several behind one gateway
  std::string uri = "local:";      // iio: where the context is, as libiio takes it
  std::string device;              // iio: name or id; comedi: device file
  std::vector<std::string> items;  // modbus: "holding 100 int32"; iio: "count0 raw"; comedi: "5 0 signed"
  Duration timeout = std::chrono::seconds(2);  // of one answer
};

class NumberSource {
 public:
  virtual ~NumberSource() = default;
  /// What they are now, one an item. The first call, and one behind a failure, opens the device.
  /// @throws DeviceFault kTimeout, kDropped, kRefused, kProtocol.
  virtual std::vector<double> Read() = 0;
  /// Who answers, as far as it tells.
  virtual std::string Identity() = 0;
};

/// Whether this build has the driver.
bool HasNumberDriver(const std::string& kind);

/// @param device  "instrument_1", for messages.
/// @param where   Of the items, for messages.
/// @throws InputError for an item that is none of its kind, or a kind that the build does not have.
std::unique_ptr<NumberSource> MakeNumberSource(const NumberSettings& settings, const std::string& device,
                                               const std::string& where);

/// What an item of the kind looks like, for messages.
std::string NumberItemForm(const std::string& kind);

}  // namespace twinbench::hw
