#pragma once

#include <comedilib.h>

#include <memory>
#include <string>
#include <vector>

#include "hw_bridge/ad/ad_source.h"
#include "twin/core/device_fault.h"

/// comedilib's C interface with owners and DeviceFaults: the card, its analogue inputs, a command that it accepts.
namespace twinbench::hw {

struct ComediCloser {
  void operator()(comedi_t* card) const { comedi_close(card); }
};
using ComediCard = std::unique_ptr<comedi_t, ComediCloser>;

/// The analogue inputs as they will be used.
struct ComediInputs {
  std::string name;  // of the card, for messages
  unsigned subdevice = 0;
  int bits = 0;
  bool wide = false;                // samples of 32 bits
  std::vector<unsigned> chanlist;   // packed channel, range and reference; scan order
  std::vector<comedi_range> range;  // of each
};

/// A command and what it amounts to. The scan list is that of ComediInputs.
struct ComediTiming {
  comedi_cmd command{};
  double scan_rate_Hz = 0.0;
  double skew_s = 0.0;  // from a channel to the next
};

[[noreturn]] inline void RefuseCard(const std::string& card_or_file, const std::string& what) {
  throw DeviceFault(FaultKind::kRefused, card_or_file, what);
}
[[noreturn]] void ThrowComedi(FaultKind kind, const std::string& card, const std::string& doing);

/// @throws DeviceFault kDropped if it does not open.
ComediCard OpenComedi(const std::string& device);

/// Finds subdevice, channels and the smallest ranges that cover what is asked for.
/// @param subdevice  -1: the first one with analogue inputs.
/// @throws DeviceFault kRefused, naming what the card has instead.
ComediInputs FindInputs(comedi_t* card, const std::string& name, int subdevice, const ScanSpec& spec);

/// Settles a command of `scans` scans.
/// @throws DeviceFault kRefused if the card does not come to accept one.
ComediTiming SettleCommand(comedi_t* card, ComediInputs& inputs, double scan_rate_Hz, int scans);

}  // namespace twinbench::hw
