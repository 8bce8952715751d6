#include "hw_bridge/control/esp_words.h"

#include <fmt/format.h>

#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr const char* kEspErrorQuery = "TB?";

/// Errors of an axis are axis * 100 + code; 4 to 7: hardware and software limits.
bool IsEspLimit(long long error) {
  const long long code = error % 100;
  return error >= 100 && code >= 4 && code <= 7;
}

}  // namespace

void TellEsp(DeviceLine& line, const std::string& command) {
  const std::string answer = line.Ask(command + "\n" + kEspErrorQuery);
  const auto comma = answer.find(',');
  const auto error = ParseWholeNumber(answer.substr(0, comma));
  if (!error || comma == std::string::npos) line.FailProtocol(kEspErrorQuery, answer, "<number>, <time>, <text>");
  if (*error == 0) return;
  line.Fail(IsEspLimit(*error) ? FaultKind::kLimit : FaultKind::kRefused,
            fmt::format("\"{}\" was refused: {}", command, answer));
}

std::vector<std::string> EspIntroductions(const std::string& token, const std::string& watchdog) {
  std::vector<std::string> said;
  if (!token.empty()) said.push_back("XK" + token + "\n" + kEspErrorQuery);
  if (!watchdog.empty()) said.push_back(watchdog + "\n" + kEspErrorQuery);
  return said;
}

bool EspKnows(DeviceLine& line, const std::string& query) {
  const std::string answer = line.Ask(query + "\n" + kEspIdentity);
  if (answer == line.identity()) {
    line.Ask(kEspErrorQuery);  // takes the complaint out of the queue
    return false;
  }
  const std::string identity = line.NextLine();
  if (identity != line.identity()) line.FailProtocol(kEspIdentity, identity, line.identity());
  return true;
}

}  // namespace twinbench::hw
