#pragma once

#include <comedi.h>

#include <memory>

#include "tests/support/comedi_device/command.h"
#include "tests/support/comedi_device/iiod_twin.h"

namespace twinbench::test {

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
