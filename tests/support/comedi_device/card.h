#pragma once

#include <comedi.h>

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

/// A multiplexed card as the kernel would show it: subdevice 0 has four analogue inputs that scan by themselves at
/// one fixed rate, subdevice 1 three digital ones, subdevice 2 two counters that stand still. Its timing and stages
/// of COMEDI_CMDTEST are those of a PCI-1710.
class Card {
 public:
  explicit Card(int descriptor);

  /// @return 0 or more, or -errno.
  int Control(unsigned long request, void* argument);
  bool failed() const { return command_ && command_->failed(); }

 private:
  int DeviceInfo(comedi_devinfo& info) const;
  int SubdeviceInfo(comedi_subdinfo* info) const;
  int RangeInfo(const comedi_rangeinfo& info) const;
  int Instruct(const comedi_insn& instruction);
  int Instruct(const comedi_insnlist& list);
  int Test(comedi_cmd& command) const;
  int Start(comedi_cmd& command);
  unsigned ConvertPeriod_ns() const;

  int descriptor_;
  CardTraits traits_;
  std::unique_ptr<Command> command_;
};

}  // namespace twinbench::test
