#pragma once

#include <optional>
#include <string>

namespace twinbench::hw {

/// Where a controller is reached: "tcp:HOST:PORT", "serial:/dev/ttyUSB0:19200", "serial:/dev/ttyUSB0:9600:7E2".
struct Address {
  enum class Kind { kTcp, kSerial };
  Kind kind = Kind::kTcp;
  std::string place;  // host or device file
  int number = 0;     // port, or baud of a serial line
  std::string frame = "8N1";  // of a serial line: data bits, parity, stop bits

  std::string Text() const;
};

inline constexpr int kDefaultBaud = 19200;

/// What an address may look like, for messages.
inline constexpr const char* kAddressForm = "\"tcp:HOST:PORT\" or \"serial:/dev/ttyUSB0:19200\"";

/// @return nothing if `text` is none of the forms above. A serial line without a rate has kDefaultBaud; a frame stands behind
///         a rate only.
std::optional<Address> ParseAddress(const std::string& text);

}  // namespace twinbench::hw
