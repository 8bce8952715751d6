#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "tests/support/comedi_device/iiod_twin.h"

namespace twinbench::test {

/// An asynchronous command: a thread that puts samples, offset binary, into the socket whose other end the program
/// reads.
class Command {
 public:
  /// @param program_end  The descriptor that the program holds; it becomes one end of a new pair.
  Command(std::unique_ptr<IiodTwin> source, int program_end, int scans, int bits);
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;
  ~Command();

  /// The driver has given up: what was read before is all there is.
  bool failed() const { return failed_; }

 private:
  void Run(int scans, int bits);
  void Put(std::span<const std::int16_t, kInputs> codes, int bits);

  std::unique_ptr<IiodTwin> source_;
  int driver_end_ = -1;
  std::atomic<bool> failed_ = false, stopped_ = false;
  std::thread thread_;
};

}  // namespace twinbench::test
