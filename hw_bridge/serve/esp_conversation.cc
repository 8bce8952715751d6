#include "hw_bridge/serve/esp_conversation.h"

#include <algorithm>
#include <cctype>

#include "hw_bridge/serve/esp_commands.h"
#include "hw_bridge/serve/words.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr std::size_t kMostErrors = 10;

const EspEntry* Find(const EspCommand& command) {
  const auto known = EspCommands();
  const auto found = std::ranges::find_if(
      known, [&](const EspEntry& entry) { return entry.name == command.name && entry.query == command.query; });
  return found == known.end() ? nullptr : &*found;
}

}  // namespace

std::optional<EspCommand> ParseEspCommand(const std::string& text) {
  EspCommand command;
  if (text.starts_with('*') && text.ends_with('?')) {  // "*IDN?": some drivers ask every instrument that
    command.name = UpperCase(text.substr(0, text.size() - 1));
    command.query = true;
    return command;
  }
  std::size_t at = 0;
  while (at < text.size() && at < 2 && std::isdigit(static_cast<unsigned char>(text[at]))) {
    command.axis = 10 * command.axis + (text[at++] - '0');
  }
  for (; command.name.size() < 2; ++at) {
    if (at >= text.size() || !std::isalpha(static_cast<unsigned char>(text[at]))) return std::nullopt;
    command.name += static_cast<char>(std::toupper(static_cast<unsigned char>(text[at])));
  }
  command.value = text.substr(at);
  command.query = EspOnlyAsks(command.name) || command.value == "?";
  if (command.value == "?") command.value.clear();
  return command;
}

double EspPatience_s(const std::string& value) {
  const auto patience_s = ParseNumber(value);
  if (!patience_s || !(*patience_s >= 0.0 && *patience_s <= CommandConversation::kLongestPatience_s))
    throw EspError{kEspOutOfRange};
  return *patience_s;
}

void EspConversation::Report(int number) {
  if (errors_.size() < kMostErrors) errors_.push_back(number);
}

int EspConversation::NextError() {
  if (errors_.empty()) return 0;
  const int number = errors_.front();
  errors_.pop_front();
  return number;
}

Outcome EspConversation::Execute(const std::string& text) {
  const auto command = ParseEspCommand(text);
  try {
    const EspEntry* entry = command ? Find(*command) : nullptr;
    if (!entry) throw EspError{kEspUnknownCommand};
    if (!IsEspOpenToAll(command->name, command->query) && !MayChange()) throw EspError{kEspNoToken};
    if (command->axis == 0 && entry->axis == EspAxis::kNeeded) throw EspError{kEspAxisMissing};
    if (command->axis > 2) throw EspError{kEspAxisOutOfRange};
    if (entry->value && command->value.empty()) throw EspError{kEspParameterMissing};
    ShownTable* tables[] = {nullptr, &served_.target, &served_.reference};
    if (command->axis > 0) served_.StrikeRestarts();
    if (command->axis > 0 && command->query) Asks(tables[command->axis]->name());
    return entry->run({*this, served_, *command, tables[command->axis]});
  } catch (const EspError& error) {
    Report(error.of_axis ? 100 * command->axis + error.number : error.number);
    return {};
  }
}

void EspConversation::Failed(const std::string&) {
  Report(kEspBenchFailed);
}

std::string EspConversation::Join(const std::vector<std::string>& answers) const {
  std::string text;
  for (const std::string& answer : answers) text += answer + "\r\n";
  return text;
}

std::string EspConversation::LineTooLong() {
  return {};
}

}  // namespace twinbench::hw
