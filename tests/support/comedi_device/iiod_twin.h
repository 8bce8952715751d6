#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <span>

namespace twinbench::test {

inline constexpr int kInputs = 4;

/// What the card is.
struct CardTraits {
  int bits = 16;
  double conversions_Hz = 250e3;
  double range_V = 10.0;
};

/// How an acquisition ended.
enum class Ending { kComplete, kFifoFull, kShort };

/// A served twin's A/D over the IIOD text protocol: an acquisition is one OPEN and READBUF of as many scans, so
/// that the card shows the twin's own counts.
class IiodTwin {
 public:
  /// @param address  "HOST:PORT", of this computer.
  explicit IiodTwin(const std::string& address) : port_(std::stoi(address.substr(address.find(':') + 1))) {}

  CardTraits Traits();
  /// Bits: 0 = light on PSD A, 1 = on PSD B, 2 = both spots inside.
  unsigned Lines();
  /// Takes scans of all inputs and hands each to `take`, two's complement; may block until Abort. A real card's FIFO fills up
  /// when the driver does not come: so a gap or an error of the twin shows as that, and a block that ends early as a command that does.
  Ending Acquire(int scans, const std::function<void(std::span<const std::int16_t, kInputs>)>& take);
  /// From another thread: Acquire is to return.
  void Abort();

 private:
  std::string Attribute(const std::string& name);

  int port_;
  std::atomic<int> streaming_ = -1;  // socket of the acquisition
  std::atomic<bool> aborted_ = false;
};

/// The twin whose IIOD $TWINBENCH_COMEDI_TWIN names as HOST:PORT.
/// @throws std::exception without it.
std::unique_ptr<IiodTwin> TwinOfThisProcess();

}  // namespace twinbench::test
