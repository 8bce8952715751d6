#include "hw_bridge/control/esp_words.h"

#include <fmt/format.h>

#include <cctype>

#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr const char* kEspErrorQuery = "TB?";
constexpr long long kGroupAlreadyAssigned = 16;

/// Errors of an axis are axis * 100 + code; 4 to 7: hardware and software limits.
bool IsEspLimit(long long error) {
  const long long code = error % 100;
  return error >= 100 && code >= 4 && code <= 7;
}

struct EspError {
  long long number = 0;
  std::string answer;  // in its words
};

EspError SayToEsp(DeviceLine& line, const std::string& command) {
  const std::string answer = line.Ask(command + "\n" + kEspErrorQuery);
  const auto comma = answer.find(',');
  const auto number = ParseWholeNumber(answer.substr(0, comma));
  if (!number || comma == std::string::npos) line.FailProtocol(kEspErrorQuery, answer, "<number>, <time>, <text>");
  return {*number, answer};
}

void RequireTaken(DeviceLine& line, const std::string& command, const EspError& error) {
  if (error.number == 0) return;
  line.Fail(IsEspLimit(error.number) ? FaultKind::kLimit : FaultKind::kRefused,
            fmt::format("\"{}\" was refused: {}", command, error.answer));
}

std::string WithoutBlanks(std::string text) {
  std::erase_if(text, [](unsigned char c) { return std::isspace(c) != 0; });
  return text;
}

}  // namespace

void TellEsp(DeviceLine& line, const std::string& command) {
  RequireTaken(line, command, SayToEsp(line, command));
}

void FormEspGroup(DeviceLine& line, std::size_t axes) {
  std::string of_axes = "1";
  for (std::size_t k = 2; k <= axes; ++k) of_axes += "," + std::to_string(k);
  const std::string command = "1HN" + of_axes;
  const EspError error = SayToEsp(line, command);
  if (error.number == kGroupAlreadyAssigned) {
    const auto is_of = EspAnswerTo(line, "1HN?");
    if (!is_of || WithoutBlanks(*is_of) == of_axes) return;  // a controller that does not tell is believed: its axes are looked at
  }
  RequireTaken(line, command, error);
}

void RequireEspUnit(DeviceLine& line, const std::string& axis, int unit) {
  const auto counts_in = line.AskWholeNumber(axis + "SN?");
  if (counts_in != unit)
    line.Fail(FaultKind::kMoved, fmt::format("axis {} was told to count in unit {} and counts in unit {}: somebody else changed it", axis,
                                             unit, counts_in));
}

std::vector<std::string> EspIntroductions(const std::string& token, const std::string& watchdog) {
  std::vector<std::string> said;
  if (!token.empty()) said.push_back("XK" + token + "\n" + kEspErrorQuery);
  if (!watchdog.empty()) said.push_back(watchdog + "\n" + kEspErrorQuery);
  return said;
}

std::optional<std::string> EspAnswerTo(DeviceLine& line, const std::string& query) {
  const std::string answer = line.Ask(query + "\n" + kEspIdentity);
  if (answer == line.identity()) {
    line.Ask(kEspErrorQuery);  // takes the complaint out of the queue
    return std::nullopt;
  }
  const std::string identity = line.NextLine();
  if (identity != line.identity()) line.FailProtocol(kEspIdentity, identity, line.identity());
  return answer;
}

}  // namespace twinbench::hw
