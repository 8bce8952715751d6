#include "hw_bridge/control/scpi.h"

#include <fmt/format.h>

#include "twin/core/number_text.h"
#include "twin/core/reading.h"

namespace twinbench::hw {
namespace {

constexpr double kScpiNotANumber = 9.91e37;
constexpr long long kDataOutOfRange = -222;
constexpr const char* kScpiErrorQuery = "SYST:ERR?";

}  // namespace

void TellScpi(DeviceLine& line, const std::string& command, Duration beyond) {
  const std::string answer = line.Ask(command + "\n" + kScpiErrorQuery, beyond);
  const auto comma = answer.find(',');
  const auto code = ParseWholeNumber(answer.substr(0, comma));
  if (!code || comma == std::string::npos) line.FailProtocol(kScpiErrorQuery, answer, "0,\"No error\"");
  if (*code == 0) return;
  line.Fail(*code == kDataOutOfRange ? FaultKind::kLimit : FaultKind::kRefused,
            fmt::format("\"{}\" was refused: {}", command, answer));
}

std::string Filled(std::string command, const std::vector<std::pair<std::string, std::string>>& places) {
  for (const auto& [place, text] : places) {
    if (const auto at = command.find(place); at != std::string::npos) command.replace(at, place.size(), text);
  }
  return command;
}

std::vector<std::string> ScpiIntroductions(const std::string& token, const std::string& watchdog) {
  std::vector<std::string> said;
  if (!token.empty()) said.push_back("SYST:TOK \"" + token + "\"\n" + kScpiErrorQuery);
  if (!watchdog.empty()) said.push_back(watchdog + "\n" + kScpiErrorQuery);
  return said;
}

std::optional<double> ParseScpiNumber(const std::string& text, double to_SI) {
  if (ParseNumber(text) == kScpiNotANumber) return kNaN;
  return ParseInUnit(text, to_SI);
}

std::optional<std::vector<std::string>> SplitScpi(const std::string& answer) {
  std::vector<std::string> fields(1);
  bool in_quotes = false;
  for (const char c : answer) {
    if (c == '"')
      in_quotes = !in_quotes;
    else if (c == ',' && !in_quotes)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  if (in_quotes) return std::nullopt;
  return fields;
}

}  // namespace twinbench::hw
