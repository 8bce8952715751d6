#include "hw_bridge/serve/scpi_conversation.h"

#include <algorithm>

#include "hw_bridge/serve/scpi_commands.h"

namespace twinbench::hw {
namespace {

constexpr int kQueryError = 4, kDeviceError = 8, kExecutionError = 16, kCommandError = 32;

int EventOf(int number) {
  if (number > -200) return kCommandError;
  if (number > -300) return kExecutionError;
  return number > -400 ? kDeviceError : kQueryError;
}

}  // namespace

void ScpiConversation::Report(const ScpiError& error) {
  errors_.Add(error);
  status_.events |= EventOf(error.number);
}

Outcome ScpiConversation::Execute(const std::string& command) {
  try {
    const auto unit = ParseScpiUnit(command);
    if (!unit) throw ScpiError{-102, ""};
    return Run(*unit);
  } catch (const ScpiError& error) {
    Report(error);
    return {};
  }
}

/// A header may also continue the path of the command before it.
Outcome ScpiConversation::Run(const ScpiUnit& unit) {
  std::vector<std::string> header = unit.header;
  ScpiFound found = FindScpiCommand(served(), header, unit.query);
  if (!found.command && !unit.rooted) {
    header.insert(header.begin(), path_.begin(), path_.end());
    found = FindScpiCommand(served(), header, unit.query);
  }
  if (!found.command) throw ScpiError{-113, ""};
  if (!IsOpenToAll(*found.command) && !MayChange()) throw ScpiError{-203, "SYST:TOK first"};
  if (!header.front().starts_with('*')) path_.assign(header.begin(), header.end() - 1);
  const std::size_t needed = found.command->parameters;
  if (unit.parameters.size() < needed) throw ScpiError{-109, ""};
  if (unit.parameters.size() > needed + found.command->optional) throw ScpiError{-108, ""};
  return found.command->run({*this, served(), found.number, unit.parameters});
}

void ScpiConversation::Failed(const std::string& what) {
  std::string text = what;
  std::ranges::replace(text, '"', '\'');
  std::ranges::replace(text, '\n', ' ');
  Report({-240, text});
}

std::string ScpiConversation::Join(const std::vector<std::string>& answers) const {
  std::string text;
  for (const std::string& answer : answers) text += (text.empty() ? "" : ";") + answer;
  return text.empty() ? text : text + "\n";
}

std::string ScpiConversation::LineTooLong() {
  Report({-363, ""});
  return errors_.Next() + "\n";
}

}  // namespace twinbench::hw
