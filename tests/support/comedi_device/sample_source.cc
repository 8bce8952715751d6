#include "tests/support/comedi_device/sample_source.h"

#include <array>
#include <atomic>
#include <cstdlib>

#include "tests/support/comedi_device/iiod_twin.h"

namespace twinbench::test {
namespace {

/// 0.2, 0.4, 0.6 and 0.8 V of 10 V, with a few codes of noise.
class SteadyVoltages : public SampleSource {
 public:
  CardTraits Traits() override { return {}; }
  unsigned Lines() override { return 7; }
  Ending Acquire(int scans, const std::function<void(std::span<const std::int16_t, kInputs>)>& take) override {
    for (int scan = 0; scan < scans && !aborted_; ++scan) {
      std::array<std::int16_t, kInputs> codes;
      for (int k = 0; k < kInputs; ++k) codes[k] = static_cast<std::int16_t>(655 * (k + 1) + Noise());
      take(codes);
    }
    return Ending::kComplete;
  }
  void Abort() override { aborted_ = true; }

 private:
  int Noise() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<int>(state_ >> 60) - 8;
  }
  std::uint64_t state_ = 1;
  std::atomic<bool> aborted_ = false;
};

}  // namespace

std::unique_ptr<SampleSource> MakeSampleSource() {
  const char* address = std::getenv("TWINBENCH_COMEDI_TWIN");
  if (address == nullptr) return std::make_unique<SteadyVoltages>();
  return std::make_unique<IiodTwin>(address);
}

}  // namespace twinbench::test
