#pragma once

#include <span>

#include "hw_bridge/serve/scpi_conversation.h"

namespace twinbench::hw {

/// A command as its handler sees it.
struct ScpiCall {
  ScpiConversation& client;
  Served& served;
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

/// Every command that the server knows, by family. Those of tables and instruments are of a ServedBench, those of
/// machines of a ServedMachine; the others of any.
std::span<const ScpiCommand> ScpiStatusCommands();
std::span<const ScpiCommand> ScpiTableCommands();
std::span<const ScpiCommand> ScpiInstrumentCommands();
std::span<const ScpiCommand> ScpiMachineCommands();
std::span<const ScpiCommand> ScpiTimeCommands();

/// Whoever has no token may ask, keep his own status and stop everything; all else changes the bench.
bool IsOpenToAll(const ScpiCommand& command);

struct ScpiFound {
  const ScpiCommand* command = nullptr;
  int number = 0;
};
ScpiFound FindScpiCommand(const Served& served, const std::vector<std::string>& header, bool query);

/// ABORt and *RST.
Outcome StopScpiDevices(const ScpiCall& call);

}  // namespace twinbench::hw
