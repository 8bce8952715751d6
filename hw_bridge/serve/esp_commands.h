#pragma once

#include <span>

#include "hw_bridge/serve/esp_conversation.h"
#include "hw_bridge/serve/esp_errors.h"

namespace twinbench::hw {

struct EspCall {
  EspConversation& client;
  ServedBench& served;
  const EspCommand& command;
  ShownTable* table;  // of its axis, if it has one
};

enum class EspAxis { kNone, kNeeded, kOptional };

struct EspEntry {
  const char* name;
  bool query;
  EspAxis axis;
  bool value;                      // needs one
  Outcome (*run)(const EspCall&);  // may throw EspError, BenchError
};

std::span<const EspEntry> EspCommands();
/// Commands that are queries without a question mark too: TP, TE, ...
bool EspOnlyAsks(const std::string& name);

}  // namespace twinbench::hw
