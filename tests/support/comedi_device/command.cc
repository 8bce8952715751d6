#include "tests/support/comedi_device/command.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>

namespace twinbench::test {
Command::Command(std::unique_ptr<IiodTwin> source, int program_end, int scans, int bits)
    : source_(std::move(source)) {
  std::array<int, 2> pair{};
  socketpair(AF_UNIX, SOCK_STREAM, 0, pair.data());
  dup2(pair[0], program_end);
  close(pair[0]);
  driver_end_ = pair[1];
  thread_ = std::thread([this, scans, bits] { Run(scans, bits); });
}

Command::~Command() {
  stopped_ = true;
  shutdown(driver_end_, SHUT_RDWR);
  source_->Abort();
  thread_.join();
  close(driver_end_);
}

void Command::Run(int scans, int bits) {
  const Ending ending =
      source_->Acquire(scans, [&](std::span<const std::int16_t, kInputs> codes) { Put(codes, bits); });
  if (stopped_) return;
  failed_ = ending == Ending::kFifoFull;
  shutdown(driver_end_, SHUT_WR);  // behind the last sample there is nothing to wait for
}

void Command::Put(std::span<const std::int16_t, kInputs> codes, int bits) {
  std::array<std::uint16_t, kInputs> samples;
  for (std::size_t k = 0; k < kInputs; ++k) samples[k] = static_cast<std::uint16_t>(codes[k] + (1 << (bits - 1)));
  send(driver_end_, samples.data(), sizeof samples, MSG_NOSIGNAL);  // fails where nobody reads any more
}

}  // namespace twinbench::test
