#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

/// Where the samples of the pretended card come from.
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

class SampleSource {
 public:
  virtual ~SampleSource() = default;
  virtual CardTraits Traits() = 0;
  /// Bits: 0 = light on PSD A, 1 = on PSD B, 2 = both spots inside.
  virtual unsigned Lines() = 0;
  /// Takes `scans` scans of all inputs and hands each to `take`, two's complement; may block until Abort.
  virtual Ending Acquire(int scans, const std::function<void(std::span<const std::int16_t, kInputs>)>& take) = 0;
  /// From another thread: Acquire is to return.
  virtual void Abort() = 0;
};

/// The twin that $TWINBENCH_COMEDI_TWIN names as HOST:PORT of its IIOD; without it, four steady voltages with
/// noise.
std::unique_ptr<SampleSource> MakeSampleSource();

}  // namespace twinbench::test
