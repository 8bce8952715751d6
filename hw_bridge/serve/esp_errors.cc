#include "hw_bridge/serve/esp_errors.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

namespace twinbench::hw {
namespace {

struct EspErrorEntry {
  int code;
  const char* text;
};
constexpr std::array kErrors = {EspErrorEntry{0, "NO ERROR DETECTED"},
                                EspErrorEntry{kEspBenchFailed, "PCI COMMUNICATION TIME-OUT"},
                                EspErrorEntry{kEspUnknownCommand, "COMMAND DOES NOT EXIST"},
                                EspErrorEntry{kEspOutOfRange, "PARAMETER OUT OF RANGE"},
                                EspErrorEntry{kEspAxisOutOfRange, "AXIS NUMBER OUT OF RANGE"},
                                EspErrorEntry{kEspNotAllowed, "COMMAND NOT ALLOWED"},
                                EspErrorEntry{kEspAxisMissing, "AXIS NUMBER MISSING"},
                                EspErrorEntry{kEspParameterMissing, "COMMAND PARAMETER MISSING"},
                                EspErrorEntry{kEspNoToken, "COMMAND PROTECTED, XK<TOKEN> FIRST"}};
constexpr std::array kAxisErrors = {EspErrorEntry{kEspAxisParameter, "PARAMETER OUT OF RANGE"},
                                    EspErrorEntry{kEspHardwareLimit, "POSITIVE HARDWARE LIMIT DETECTED"},
                                    EspErrorEntry{kEspHardwareLimit + 1, "NEGATIVE HARDWARE LIMIT DETECTED"},
                                    EspErrorEntry{kEspSoftLimit, "POSITIVE SOFTWARE LIMIT DETECTED"},
                                    EspErrorEntry{kEspSoftLimit + 1, "NEGATIVE SOFTWARE LIMIT DETECTED"},
                                    EspErrorEntry{kEspMotorOff, "MOTOR NOT ENABLED"}};

}  // namespace

bool IsEspOpenToAll(const std::string& name, bool query) {
  constexpr std::array<std::string_view, 9> kOpen = {"ST", "AB", "HS", "WS",          "WT",
                                                     "HN", "SN", kEspShowToken, kEspWatchdog};
  return query || std::ranges::find(kOpen, name) != kOpen.end();
}

const char* EspErrorText(int number) {
  const std::span<const EspErrorEntry> texts = number < 100 ? std::span<const EspErrorEntry>(kErrors) : kAxisErrors;
  const auto found = std::ranges::find(texts, number % 100, &EspErrorEntry::code);
  return found == texts.end() ? "UNKNOWN" : found->text;
}

}  // namespace twinbench::hw
