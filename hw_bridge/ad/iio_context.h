#pragma once

#include <iio.h>

#include <memory>
#include <optional>
#include <string>

#include "twin/core/device_fault.h"
#include "twin/core/time.h"

/// libiio's C interface with owners, deadlines and DeviceFaults.
namespace twinbench::hw {

struct IioContextCloser {
  void operator()(iio_context* context) const { iio_context_destroy(context); }
};
using IioContext = std::unique_ptr<iio_context, IioContextCloser>;

/// The fault that an errno of a driver stands for.
FaultKind FaultOf(int error);
[[noreturn]] void ThrowErrno(const std::string& device, const std::string& doing, int error);

/// Opens "ip:HOST[:PORT]", "usb:...", "local:", "xml:FILE". libiio may take 5 s for every answer of a server that
/// has gone silent; this gives up at the deadline. From the first call on SIGPIPE is ignored, unless somebody
/// handles it.
/// @throws DeviceFault kTimeout, kDropped, kRefused.
IioContext OpenIioContext(const std::string& uri, Duration deadline);

/// @return the text of an attribute without blanks at its end; nothing if there is no such attribute.
/// @throws DeviceFault if the attribute is there and cannot be read.
std::optional<std::string> DeviceText(const iio_device* device, const std::string& attribute);
std::optional<std::string> ChannelText(const iio_channel* channel, const std::string& attribute);
std::optional<std::string> ContextText(const iio_context* context, const std::string& attribute);

/// The same as a number. @throws DeviceFault kProtocol if it is none.
std::optional<double> DeviceNumber(const iio_device* device, const std::string& attribute);
std::optional<double> ChannelNumber(const iio_channel* channel, const std::string& attribute);

}  // namespace twinbench::hw
