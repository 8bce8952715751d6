#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hw_bridge/control/device_line.h"

/// The manners of SCPI-99 (docs/protocols.md).
namespace twinbench::hw {

inline constexpr const char* kScpiIdentity = "*IDN?";

/// Sends a command and asks the error queue how it went.
/// @throws DeviceFault kLimit for -222, kRefused for another error; what DeviceLine throws.
void TellScpi(DeviceLine& line, const std::string& command, Duration beyond = {});

/// A command as a bench file words it, with what stands for its places: {"{tooth}", "12"}. A place that it has not is left
/// out.
std::string Filled(std::string command, const std::vector<std::pair<std::string, std::string>>& places);

/// Commands with the query of their errors, for Dialogue::IntroduceBy: the token of a served twin, and a watchdog as the bench file words it.
/// @param token, watchdog  Empty: none.
std::vector<std::string> ScpiIntroductions(const std::string& token, const std::string& watchdog);

/// The number in `text` times `to_SI`; NaN for 9.91E37, which is SCPI's "not a number".
/// @return nothing if there is anything else in it.
std::optional<double> ParseScpiNumber(const std::string& text, double to_SI);

/// The fields of an answer: separated by commas that do not stand in quotes; a text loses its quotes.
/// @return nothing if a quote is not closed.
std::optional<std::vector<std::string>> SplitScpi(const std::string& answer);

}  // namespace twinbench::hw
