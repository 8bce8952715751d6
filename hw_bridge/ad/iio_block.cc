#include "hw_bridge/ad/iio_block.h"

#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>

#include "hw_bridge/ad/iio_context.h"

namespace twinbench::hw {
namespace {

/// A buffer that does not wait for a server's goodbye once something went wrong.
class Buffer {
 public:
  Buffer(const IioChannels& from, int scans)
      : buffer_(iio_device_create_buffer(from.device, static_cast<std::size_t>(scans), false)) {
    if (buffer_ == nullptr) ThrowErrno(from.name, "opening a buffer of " + std::to_string(scans) + " scans", errno);
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() {
    if (!whole_) iio_buffer_cancel(buffer_);  // otherwise closing would wait for an answer as long as reading did
    iio_buffer_destroy(buffer_);
  }
  iio_buffer* get() { return buffer_; }
  void IsWhole() { whole_ = true; }

 private:
  iio_buffer* buffer_;
  bool whole_ = false;
};

/// Cancels the buffer at the deadline unless it goes before: libiio's own timeout is for each piece of a block.
class Watchdog {
 public:
  Watchdog(iio_buffer* buffer, Duration deadline) : thread_([=, this] { Watch(buffer, deadline); }) {}
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;
  ~Watchdog() { CallOff(); }

  /// @return true if the deadline has passed.
  bool CallOff() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    called_off_.notify_one();
    if (thread_.joinable()) thread_.join();
    return barked_;
  }

 private:
  void Watch(iio_buffer* buffer, Duration deadline) {
    std::unique_lock lock(mutex_);
    if (called_off_.wait_for(lock, deadline, [this] { return done_; })) return;
    barked_ = true;
    iio_buffer_cancel(buffer);
  }

  std::mutex mutex_;
  std::condition_variable called_off_;
  bool done_ = false, barked_ = false;
  std::thread thread_;
};

void Refill(Buffer& buffer, const IioChannels& from, int scans, Duration deadline) {
  Watchdog watchdog(buffer.get(), deadline);
  const ssize_t bytes = iio_buffer_refill(buffer.get());
  if (watchdog.CallOff()) {
    throw DeviceFault(FaultKind::kTimeout, from.name,
                      "no block within " + std::to_string(ToSeconds(deadline)) + " s");
  }
  if (bytes < 0) ThrowErrno(from.name, "reading a block", static_cast<int>(-bytes));
  const std::ptrdiff_t step = iio_buffer_step(buffer.get());
  if (step <= 0 || bytes < scans * step) {
    throw DeviceFault(FaultKind::kDropped, from.name,
                      "a block ended after " + std::to_string(bytes) + " bytes, " + std::to_string(scans) +
                          " scans of " + std::to_string(step) + " bytes were asked for");
  }
}

/// One channel's codes as numbers of its own width, in the byte order of this machine.
template <class Code>
std::vector<Code> CodesOf(iio_channel* channel, iio_buffer* buffer, int scans) {
  std::vector<Code> codes(static_cast<std::size_t>(scans));
  iio_channel_read(channel, buffer, codes.data(), codes.size() * sizeof(Code));
  return codes;
}

template <class Code>
void Put(iio_channel* channel, iio_buffer* buffer, int scans, std::size_t place, std::size_t step,
         std::vector<std::int16_t>& raw) {
  const iio_data_format& format = *iio_channel_get_data_format(channel);
  const std::int64_t middle = format.is_signed ? 0 : std::int64_t{1} << (format.bits - 1);
  std::size_t i = place;
  for (const Code code : CodesOf<Code>(channel, buffer, scans)) {
    raw[i] = static_cast<std::int16_t>(code - middle);
    i += step;
  }
}

void PutChannel(iio_channel* channel, iio_buffer* buffer, int scans, std::size_t place, std::size_t step,
                std::vector<std::int16_t>& raw) {
  const iio_data_format& format = *iio_channel_get_data_format(channel);
  switch (format.is_signed ? -static_cast<int>(format.length) : static_cast<int>(format.length)) {
    case -8:
      return Put<std::int8_t>(channel, buffer, scans, place, step, raw);
    case 8:
      return Put<std::uint8_t>(channel, buffer, scans, place, step, raw);
    case -16:
      return Put<std::int16_t>(channel, buffer, scans, place, step, raw);
    case 16:
      return Put<std::uint16_t>(channel, buffer, scans, place, step, raw);
    case -32:
      return Put<std::int32_t>(channel, buffer, scans, place, step, raw);
    default:
      return Put<std::uint32_t>(channel, buffer, scans, place, step, raw);
  }
}

}  // namespace

int BitsOf(const iio_channel* channel) {
  const iio_data_format& format = *iio_channel_get_data_format(channel);
  const bool held = format.length == 8 || format.length == 16 || format.length == 32;
  return held && format.repeat == 1 && format.bits >= 2 && format.bits <= 16 ? static_cast<int>(format.bits) : 0;
}

IioBlock TakeIioBlock(const IioChannels& from, int scans, Duration deadline) {
  Buffer buffer(from, scans);
  Refill(buffer, from, scans, deadline);
  const std::size_t n = from.channels.size();
  IioBlock block;
  block.raw.resize(static_cast<std::size_t>(scans) * n);
  for (std::size_t k = 0; k < n; ++k) PutChannel(from.channels[k], buffer.get(), scans, k, n, block.raw);
  if (from.timestamp != nullptr) block.stamps_ns = CodesOf<std::int64_t>(from.timestamp, buffer.get(), scans);
  buffer.IsWhole();
  return block;
}

}  // namespace twinbench::hw
