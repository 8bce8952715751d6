#pragma once

#include <deque>

#include "hw_bridge/serve/command_conversation.h"
#include "hw_bridge/serve/esp_errors.h"
#include "hw_bridge/serve/served_bench.h"

namespace twinbench::hw {

/// A command of the Newport ESP dialect taken apart: "1PA12.5".
struct EspCommand {
  int axis = 0;        // 0: none given
  std::string name;    // two letters, capitals; or "*IDN"
  std::string value;   // "12.5"
  bool query = false;  // "1PA?", and all that can only be asked ("1TP")
};

/// @return nothing unless it is a number of up to two digits or none, two letters, and the rest; or a common query
/// of
///         IEEE 488.2.
std::optional<EspCommand> ParseEspCommand(const std::string& text);

/// What XW takes: seconds from 0 to an hour. @throws EspError for anything else.
double EspPatience_s(const std::string& value);

/// XK and XW, the same on tables and on a machine.
/// @tparam Call  EspCall or EspMachineCall.
template <class Call>
Outcome ShowEspToken(const Call& call) {
  if (!call.client.Show(call.command.value)) throw EspError{kEspNoToken};
  return {};
}
template <class Call>
Outcome ArmEspWatchdog(const Call& call) {
  call.client.BeMissed(EspPatience_s(call.command.value));
  return {};
}

/// Newport ESP300/301. Axis 1 is the target, 2 the reference; degrees. Its commands are a table in esp_commands.cc.
///
/// Errors: numbers of the manual, those of an axis are axis * 100 + code. The table of errors is as in PyMeasure's
/// driver.
class EspConversation : public CommandConversation {
 public:
  explicit EspConversation(ServedBench& served) : CommandConversation(served), served_(served) {}

  using CommandConversation::BeMissed;
  using CommandConversation::Show;
  /// Adds to the error buffer; it keeps the oldest ten, like the controller.
  void Report(int number);
  int NextError();  // 0: none
  bool HasErrors() const { return !errors_.empty(); }

 protected:
  Outcome Execute(const std::string& command) override;
  void Failed(const std::string& what) override;
  std::string Join(const std::vector<std::string>& answers) const override;
  std::string LineTooLong() override;

 private:
  ServedBench& served_;
  std::deque<int> errors_;
};

}  // namespace twinbench::hw
