#include "hw_bridge/serve/scpi_commands.h"

#include <string_view>

namespace twinbench::hw {

bool IsOpenToAll(const ScpiCommand& command) {
  const std::string_view header = command.header;
  return command.query || header.starts_with('*') || header.starts_with("SYSTem") || header.starts_with("ABORt") ||
         header.ends_with(":STOP");
}

ScpiFound FindScpiCommand(const Served& served, const std::vector<std::string>& header, bool query) {
  std::vector<std::span<const ScpiCommand>> families = {ScpiStatusCommands(), ScpiTimeCommands()};
  for (const auto family : served.OwnScpiCommands()) families.push_back(family);
  for (const auto family : families) {
    for (const ScpiCommand& command : family) {
      if (command.query != query) continue;
      if (const auto number = MatchHeader(command.header, header)) return {&command, *number};
    }
  }
  return {};
}

Outcome StopScpiDevices(const ScpiCall& call) {
  call.served.pace().CatchUp();
  call.served.StopAll();
  return {};
}

}  // namespace twinbench::hw
