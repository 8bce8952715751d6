#pragma once

#include <deque>

#include "hw_bridge/serve/esp_conversation.h"
#include "hw_bridge/serve/served_machine.h"

namespace twinbench::hw {

/// Newport ESP300/301 of a machine: axes 1 to N in mm or degrees, all of them group 1, which goes along lines and
/// arcs. Its commands are a table in esp_machine_commands.cc.
class EspMachineConversation : public CommandConversation {
 public:
  explicit EspMachineConversation(ServedMachine& served) : CommandConversation(served), served_(served) {}

  using CommandConversation::BeMissed;
  using CommandConversation::Show;
  void Report(int number);
  int NextError();  // 0: none

  /// What a group remembers between commands.
  double feed_m_s = 0.0;  // 0: as fast as it goes
  int triggers = 0;       // of the next arc
  double first_trigger_rad = 0.0, trigger_step_rad = 0.0;

 protected:
  Outcome Execute(const std::string& command) override;
  void Failed(const std::string& what) override;
  std::string Join(const std::vector<std::string>& answers) const override;
  std::string LineTooLong() override { return {}; }

 private:
  ServedMachine& served_;
  std::deque<int> errors_;
};

struct EspMachineCall {
  EspMachineConversation& client;
  ServedMachine& served;
  const EspCommand& command;
  std::size_t axis = 0;  // from 0; of a command of an axis
};

enum class EspPart { kController, kAxis, kGroup };

struct EspMachineEntry {
  const char* name;
  bool query;
  EspPart part;
  Outcome (*run)(const EspMachineCall&);  // may throw EspError, BenchError
};

std::span<const EspMachineEntry> EspMachineCommands();

}  // namespace twinbench::hw
