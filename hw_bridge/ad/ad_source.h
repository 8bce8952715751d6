#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hw_bridge/bench_file.h"
#include "twin/core/devices.h"

/// What the bridge asks of any A/D card: the union of what libiio and comedilib need, with nothing of either in it.
/// A driver for a closed SDK implements AdSource outside this tree and is added to MakeAdSource (docs/hardware.md).
namespace twinbench::hw {

struct ScanChannel {
  std::string id;    // of the driver: "voltage0", "3"
  double range_V = 10.0;
  std::string reference = "ground";  // ground, common, differential
};

/// What is asked for.
struct ScanSpec {
  std::vector<ScanChannel> channels;  // in scan order
  double scan_rate_Hz = 62.5e3;
  Duration deadline{};                // for a block, beyond its own length; for an answer
};

/// volts = sum_k c_k (code - origin)^k
struct CalibrationPolynomial {
  double origin = 0.0;
  std::vector<double> coefficients_V;
};

/// What the card will do, as it answers; this is what is recorded.
struct Negotiated {
  ScanSpec actual;
  std::vector<double> skew_s;                      // of each channel against the first
  int bits = 16;
  std::vector<CalibrationPolynomial> calibration;  // one a channel, of two's complement codes
  bool calibrated = false;    // false: the polynomials only say what range and bits say
  std::string identity, serial, firmware;  // empty: the driver does not tell
  bool stamps_scans = false;  // every scan has a time stamp, so that a lost one shows
};

/// A block as it came off the card, in two's complement whatever the driver's coding is.
struct AdBlock {
  std::vector<std::int16_t> raw;  // scans x channels, scan order
  BlockStamp stamp;
  Time start{};               // device time of the first scan, where the card tells; otherwise host
  std::string light = "ok";   // "ok", "no_light", "clipped_spot": what the PSD amplifiers' status lines say, if wired
};

/// One A/D card. Every call may throw DeviceFault; after one, the next Take opens the card again and asks it to be
/// what it was.
class AdSource {
 public:
  virtual ~AdSource() = default;
  /// Opens the card and settles with it what it will do.
  /// @throws DeviceFault kIdentity, kRefused, kTimeout, kDropped.
  virtual Negotiated Configure(const ScanSpec& spec) = 0;
  /// Starts the card, takes `scans` scans and stops it.
  /// @throws DeviceFault kTimeout, kDropped, kGap, kOverrun, kProtocol. A partial block is never returned.
  virtual AdBlock Take(int scans) = 0;
};

/// Whether this build has the driver "iio" or "comedi".
bool HasAdDriver(const std::string& kind);

/// @throws InputError for a kind that does not exist or that this build does not have, and for settings that the
///         driver has no use for.
std::unique_ptr<AdSource> MakeAdSource(const AdSettings& settings);

}  // namespace twinbench::hw
