#include "tests/support/comedi_device/command.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>

namespace twinbench::test {
namespace {

std::string Fault() {
  const char* fault = std::getenv("TWINBENCH_COMEDI_FAULT");
  return fault != nullptr ? fault : "";
}

}  // namespace

Command::Command(std::unique_ptr<SampleSource> source, int program_end, int scans, int bits)
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
  const std::string fault = Fault();
  int left = fault.empty() ? scans : scans / 2;
  const Ending ending = source_->Acquire(scans, [&](std::span<const std::int16_t, kInputs> codes) {
    if (left > 0 && Put(codes, bits)) --left;
  });
  if (stopped_ || fault == "stall") return;
  failed_ = ending == Ending::kFifoFull || fault == "fifo_full";
  shutdown(driver_end_, SHUT_WR);  // behind the last sample there is nothing to wait for
}

bool Command::Put(std::span<const std::int16_t, kInputs> codes, int bits) {
  std::array<std::uint16_t, kInputs> samples;
  for (std::size_t k = 0; k < kInputs; ++k) samples[k] = static_cast<std::uint16_t>(codes[k] + (1 << (bits - 1)));
  return send(driver_end_, samples.data(), sizeof samples, MSG_NOSIGNAL) == static_cast<ssize_t>(sizeof samples);
}

}  // namespace twinbench::test
