#include "hw_bridge/serve/iiod_delivery.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>

#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

constexpr std::size_t kPiece = 65536;  // bytes that go out at a time

bool BreaksOff(Injected fault) {
  return fault == Injected::kDrop || fault == Injected::kStall;
}

bool EndsEarly(Injected fault) {
  return BreaksOff(fault) || fault == Injected::kShort || fault == Injected::kError;
}

}  // namespace

IiodDelivery::IiodDelivery(ServedBench& served, IiodBuffer& buffer, std::size_t bytes)
    : served_(served),
      buffer_(buffer),
      scan_bytes_(ScanBytes(buffer.mask())),
      asked_bytes_(bytes),
      scans_(bytes / scan_bytes_),
      end_(scans_) {
  if (!buffer_.Ask(scans_)) state_ = State::kRefused;
}

Step IiodDelivery::Next() {
  if (state_ == State::kRefused) {
    state_ = State::kDone;
    return NumberLine(-ENOMEM);
  }
  if (state_ == State::kCollecting) return Collect();
  if (state_ == State::kAnnouncing) return Announce();
  return sent_ < end_ ? Send({}) : End();
}

Step IiodDelivery::Collect() {
  try {
    if (!buffer_.Collect()) return Step::Wait(served_.paced.Timeless() ? WallClock::duration::zero() : kPollEvery);
  } catch (const BenchError&) {
    state_ = State::kDone;
    return NumberLine(-EIO);
  }
  fault_ = buffer_.Suffer();
  if (EndsEarly(fault_)) end_ = scans_ / 2;
  state_ = State::kAnnouncing;
  const auto lag = served_.paced.Held() ? served_.paced.Lag() : WallClock::duration::zero();
  return lag > WallClock::duration::zero() ? Step::Wait(lag) : Announce();
}

/// A block that breaks off is announced whole: it is the connection that fails.
Step IiodDelivery::Announce() {
  state_ = State::kSending;
  const std::size_t announced = (BreaksOff(fault_) ? scans_ : end_) * scan_bytes_;
  return announced == 0 ? End() : Send(fmt::format("{}\n{}\n", announced, PrintIiodMask(buffer_.mask())));
}

Step IiodDelivery::Send(std::string bytes) {
  const std::size_t n = std::min(end_ - sent_, std::max<std::size_t>(kPiece / scan_bytes_, 1));
  bytes += buffer_.Encode(sent_, n);
  sent_ += n;
  return Step::Send(std::move(bytes));
}

Step IiodDelivery::End() {
  state_ = State::kDone;
  buffer_.Release();
  if (fault_ == Injected::kDrop) return Step::Close();
  if (fault_ == Injected::kStall) return Step::Silence();
  if (fault_ == Injected::kError) return NumberLine(-EIO);
  return end_ * scan_bytes_ == asked_bytes_ ? Step::Send({}) : NumberLine(0);
}

}  // namespace twinbench::hw
