#pragma once

#include <atomic>
#include <string>

#include "tests/support/comedi_device/sample_source.h"

namespace twinbench::test {

/// A served twin's A/D over the IIOD text protocol: an acquisition is one OPEN and READBUF of as many scans, so
/// that the card shows the twin's own counts.
class IiodTwin : public SampleSource {
 public:
  /// @param address  "HOST:PORT", numeric.
  explicit IiodTwin(const std::string& address) : address_(address) {}

  CardTraits Traits() override;
  unsigned Lines() override;
  /// A real card's FIFO fills up when the driver does not come: so a gap or an error of the twin shows as that, and
  /// a block that ends early as a command that does.
  Ending Acquire(int scans, const std::function<void(std::span<const std::int16_t, kInputs>)>& take) override;
  void Abort() override;

 private:
  std::string Attribute(const std::string& name);

  std::string address_;
  std::atomic<int> streaming_ = -1;  // socket of the acquisition
  std::atomic<bool> aborted_ = false;
};

}  // namespace twinbench::test
