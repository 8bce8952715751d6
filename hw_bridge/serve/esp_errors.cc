#include "hw_bridge/serve/esp_errors.h"

#include <algorithm>
#include <array>
#include <span>

namespace twinbench::hw {
namespace {

struct ErrorText {
  int code;
  const char* text;
};
constexpr std::array kErrors = {ErrorText{0, "NO ERROR DETECTED"},
                                ErrorText{kEspBenchFailed, "PCI COMMUNICATION TIME-OUT"},
                                ErrorText{kEspUnknownCommand, "COMMAND DOES NOT EXIST"},
                                ErrorText{kEspOutOfRange, "PARAMETER OUT OF RANGE"},
                                ErrorText{kEspAxisOutOfRange, "AXIS NUMBER OUT OF RANGE"},
                                ErrorText{kEspNotAllowed, "COMMAND NOT ALLOWED"},
                                ErrorText{kEspAxisMissing, "AXIS NUMBER MISSING"},
                                ErrorText{kEspParameterMissing, "COMMAND PARAMETER MISSING"}};
constexpr std::array kAxisErrors = {ErrorText{kEspAxisParameter, "PARAMETER OUT OF RANGE"},
                                    ErrorText{kEspHardwareLimit, "POSITIVE HARDWARE LIMIT DETECTED"},
                                    ErrorText{kEspHardwareLimit + 1, "NEGATIVE HARDWARE LIMIT DETECTED"},
                                    ErrorText{kEspSoftLimit, "POSITIVE SOFTWARE LIMIT DETECTED"},
                                    ErrorText{kEspSoftLimit + 1, "NEGATIVE SOFTWARE LIMIT DETECTED"},
                                    ErrorText{kEspMotorOff, "MOTOR NOT ENABLED"}};

}  // namespace

const char* EspErrorText(int number) {
  const std::span<const ErrorText> texts = number < 100 ? std::span<const ErrorText>(kErrors) : kAxisErrors;
  const auto found = std::ranges::find(texts, number % 100, &ErrorText::code);
  return found == texts.end() ? "UNKNOWN" : found->text;
}

}  // namespace twinbench::hw
