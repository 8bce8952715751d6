#include "hw_bridge/serve/scpi_commands.h"

namespace twinbench::hw {

ScpiFound FindScpiCommand(const std::vector<std::string>& header, bool query) {
  for (const auto family :
       {ScpiStatusCommands(), ScpiTableCommands(), ScpiInstrumentCommands(), ScpiTimeCommands()}) {
    for (const ScpiCommand& command : family) {
      if (command.query != query) continue;
      if (const auto number = MatchHeader(command.header, header)) return {&command, *number};
    }
  }
  return {};
}

Outcome StopScpiTables(const ScpiCall& call) {
  call.served.paced.CatchUp();
  call.served.StopTables();
  return {};
}

}  // namespace twinbench::hw
