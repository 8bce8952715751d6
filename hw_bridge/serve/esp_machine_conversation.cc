#include "hw_bridge/serve/esp_machine_conversation.h"

#include <algorithm>

#include "hw_bridge/serve/esp_errors.h"
#include "twin/core/device_fault.h"

namespace twinbench::hw {
namespace {

constexpr std::size_t kMostEspErrors = 10;
constexpr int kTheGroup = 1;

const EspMachineEntry* FindEntry(const EspCommand& command) {
  const auto known = EspMachineCommands();
  const auto found = std::ranges::find_if(
      known, [&](const EspMachineEntry& e) { return e.name == command.name && e.query == command.query; });
  return found == known.end() ? nullptr : &*found;
}

/// @return the axis from 0, or 0 where there is none.
std::size_t RequirePart(const EspCommand& command, EspPart part, std::size_t axes) {
  if (part == EspPart::kController) return 0;
  if (command.axis == 0) throw EspError{kEspAxisMissing};
  const std::size_t most = part == EspPart::kGroup ? kTheGroup : axes;
  if (static_cast<std::size_t>(command.axis) > most) throw EspError{kEspAxisOutOfRange};
  return static_cast<std::size_t>(command.axis) - 1;
}

}  // namespace

void EspMachineConversation::Report(int number) {
  if (errors_.size() < kMostEspErrors) errors_.push_back(number);
}

int EspMachineConversation::NextError() {
  if (errors_.empty()) return 0;
  const int number = errors_.front();
  errors_.pop_front();
  return number;
}

Outcome EspMachineConversation::Execute(const std::string& text) {
  const auto command = ParseEspCommand(text);
  try {
    const EspMachineEntry* entry = command ? FindEntry(*command) : nullptr;
    if (!entry) throw EspError{kEspUnknownCommand};
    if (!IsEspOpenToAll(command->name, command->query) && !MayChange()) throw EspError{kEspNoToken};
    const std::size_t axis = RequirePart(*command, entry->part, served_.machine.Axes().size());
    served_.paced.CatchUp();
    served_.machine.StrikeRestart();
    if (command->query && entry->part != EspPart::kController) Asks(ShownMachine::kName);
    return entry->run({*this, served_, *command, axis});
  } catch (const EspError& error) {
    const int axis = std::max(1, command ? command->axis : 1);
    Report(error.of_axis ? 100 * axis + error.number : error.number);
    return {};
  } catch (const DeviceFault& fault) {  // the machine says no
    Report(fault.kind() == FaultKind::kLimit ? 100 + kEspSoftLimit : kEspNotAllowed);
    return {};
  }
}

void EspMachineConversation::Failed(const std::string&) {
  Report(kEspBenchFailed);
}

std::string EspMachineConversation::Join(const std::vector<std::string>& answers) const {
  std::string text;
  for (const std::string& answer : answers) text += answer + "\r\n";
  return text;
}

}  // namespace twinbench::hw
