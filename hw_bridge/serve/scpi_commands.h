#pragma once

#include <span>

#include "hw_bridge/serve/scpi_conversation.h"

namespace twinbench::hw {

/// A command as its handler sees it.
struct ScpiCall {
  ScpiConversation& client;
  ServedBench& served;
  int number;  // of the keyword with a number
  const std::vector<std::string>& parameters;
};

struct ScpiCommand {
  const char* header;  // "ROTation#:ANGLe"
  bool query;
  std::size_t parameters;           // that it needs
  std::size_t optional;             // that it may have besides
  Outcome (*run)(const ScpiCall&);  // may throw ScpiError, BenchError
};

/// Every command that the server knows, by family.
std::span<const ScpiCommand> ScpiStatusCommands();
std::span<const ScpiCommand> ScpiTableCommands();
std::span<const ScpiCommand> ScpiInstrumentCommands();
std::span<const ScpiCommand> ScpiTimeCommands();

struct ScpiFound {
  const ScpiCommand* command = nullptr;
  int number = 0;
};
ScpiFound FindScpiCommand(const std::vector<std::string>& header, bool query);

/// ABORt and *RST.
Outcome StopScpiTables(const ScpiCall& call);

}  // namespace twinbench::hw
