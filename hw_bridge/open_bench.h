#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hw_bridge/bench_file.h"
#include "twin/core/devices.h"
#include "twin/core/table_limits.h"

namespace twinbench::hw {

struct AgreedLimits {
  TableLimits target, reference;
};

/// The devices of a bench, connected, identified and configured; closed when this goes.
class OpenBench {
 public:
  virtual ~OpenBench() = default;
  virtual RotaryBench Bench() = 0;
  /// Who answered, with versions and serial numbers; the record keeps it.
  virtual std::string Identity() const = 0;
  /// What the A/D card agreed to, one line a channel; the record keeps it.
  virtual std::vector<std::string> Configuration() const { return {}; }
  /// What both tables may be asked to do: the bench file's limits, narrowed to what their controllers allow; none where
  /// no controller was asked.
  virtual std::optional<AgreedLimits> Limits() const { return std::nullopt; }
  /// From here on `listener` is told at once what the computer's clocks do: "the wall clock has gone ...".
  virtual void HearClock(std::function<void(const std::string&)> /*listener*/) {}
  /// What was noticed during the run without being a fault: drift of the card's clock, mains hum.
  virtual std::vector<std::string> Notices() const { return {}; }
};

/// Opens a bench of kind "hardware".
/// @param adc       Says which rate, range, resolution and block length the A/D must give.
/// @param elapsed   Time 0 of the run was so long ago (a resumed run); 0 for a new one.
/// @param run       Which run of its bench a served twin makes, as Scenario::repeat; 0: its own.
/// @param stop_asked  Heard by every device, as DeviceLine::HearStop; none: nobody stops them.
/// @throws DeviceFault if a device does not answer, is not the one named or cannot do what is asked.
std::unique_ptr<OpenBench> OpenHardware(const BenchFile& file, const AdcSettings& adc, double noise_V,
                                        Duration elapsed = {}, int run = 0, const std::function<bool()>& stop_asked = {});

}  // namespace twinbench::hw
