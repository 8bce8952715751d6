#include "tests/support/comedi_device/iiod_twin.h"

#include <cmath>
#include <cstring>

#include "tests/support/tcp_client.h"

namespace twinbench::test {
namespace {

constexpr const char* kDevice = "psd-adc16";
constexpr const char* kMask = "0000001f";  // four inputs and the time stamp
constexpr std::size_t kScanBytes = kInputs * sizeof(std::int16_t) + sizeof(std::int64_t);

/// Scans out of bytes that come in any pieces; watches their time stamps.
class Scans {
 public:
  explicit Scans(double period_ns) : period_ns_(period_ns) {}

  /// @return false where a scan is missing.
  bool Feed(const std::string& bytes, const std::function<void(std::span<const std::int16_t, kInputs>)>& take) {
    rest_ += bytes;
    std::size_t at = 0;
    for (; at + kScanBytes <= rest_.size(); at += kScanBytes) {
      std::array<std::int16_t, kInputs> codes;
      std::int64_t stamp_ns = 0;
      std::memcpy(codes.data(), &rest_[at], sizeof codes);
      std::memcpy(&stamp_ns, &rest_[at + sizeof codes], sizeof stamp_ns);
      if (!Follows(stamp_ns)) return false;
      take(codes);
    }
    rest_.erase(0, at);
    return true;
  }

 private:
  bool Follows(std::int64_t stamp_ns) {
    const bool follows =
        !any_ || std::abs(static_cast<double>(stamp_ns - last_ns_) - period_ns_) < 0.5 * period_ns_;
    any_ = true;
    last_ns_ = stamp_ns;
    return follows;
  }

  double period_ns_;
  std::string rest_;
  bool any_ = false;
  std::int64_t last_ns_ = 0;
};

}  // namespace

std::string IiodTwin::Attribute(const std::string& name) {
  TcpClient twin(port_);
  const auto length = twin.AskNumber(std::string("READ ") + kDevice + " " + name);
  if (length < 0) throw std::runtime_error("the twin has no " + name);
  const std::string text = twin.Bytes(static_cast<std::size_t>(length));
  return text.c_str();  // up to its NUL
}

CardTraits IiodTwin::Traits() {
  return {std::stoi(Attribute("bits")), std::stod(Attribute("conversion_frequency")),
          std::stod(Attribute("range_V"))};
}

unsigned IiodTwin::Lines() {
  const std::string light = Attribute("light");
  if (light == "ok") return 7;
  return light == "clipped_spot" ? 3 : 4;
}

Ending IiodTwin::Acquire(int scans, const std::function<void(std::span<const std::int16_t, kInputs>)>& take) {
  try {
    Scans taken(kInputs * 1e9 / std::stod(Attribute("conversion_frequency")));
    TcpClient twin(port_);
    streaming_ = twin.number();
    if (aborted_) throw std::runtime_error("aborted");
    if (twin.AskNumber(std::string("OPEN ") + kDevice + " " + std::to_string(scans) + " " + kMask) < 0)
      return Ending::kFifoFull;
    std::size_t missing = static_cast<std::size_t>(scans) * kScanBytes;
    twin.Send(std::string("READBUF ") + kDevice + " " + std::to_string(missing) + "\n");
    for (bool first = true; missing > 0; first = false) {
      const long n = std::stol(twin.Line());
      if (n == 0) return Ending::kShort;
      if (n < 0) return Ending::kFifoFull;
      if (first) twin.Line();  // the mask
      if (!taken.Feed(twin.Bytes(static_cast<std::size_t>(n)), take)) return Ending::kFifoFull;
      missing -= static_cast<std::size_t>(n);
    }
    streaming_ = -1;
    twin.AskNumber(std::string("CLOSE ") + kDevice);
    return Ending::kComplete;
  } catch (const std::runtime_error&) {
    streaming_ = -1;
    return Ending::kFifoFull;
  }
}

void IiodTwin::Abort() {
  aborted_ = true;
  const int streaming = streaming_;
  if (streaming >= 0) shutdown(streaming, SHUT_RDWR);
}

std::unique_ptr<IiodTwin> TwinOfThisProcess() {
  const char* address = std::getenv("TWINBENCH_COMEDI_TWIN");
  if (address == nullptr) throw std::runtime_error("TWINBENCH_COMEDI_TWIN names no twin");
  return std::make_unique<IiodTwin>(address);
}

}  // namespace twinbench::test
