#pragma once

#include <optional>

#include "hw_bridge/control/device_line.h"

/// The manners of Newport ESP controllers. Reference: Newport, ESP301 user's manual, section 3 and appendix A.
namespace twinbench::hw {

inline constexpr const char* kEspIdentity = "VE?";
inline constexpr int kEspMillimetre = 2, kEspDegree = 7;  // units of an axis

/// Sends a command and asks for the error that it made.
/// @throws DeviceFault kLimit for a limit of an axis, kRefused for another error; what DeviceLine throws.
void TellEsp(DeviceLine& line, const std::string& command);

/// Makes axes 1 to `axes` its group 1. One that is there already is no matter if it is of the same axes.
/// @throws DeviceFault kRefused if it is of others.
void FormEspGroup(DeviceLine& line, std::size_t axes);

/// Before every move: a place in another unit is another place, beyond any limit.
/// @param axis  "1"
/// @param unit  That it was told.
/// @throws DeviceFault kMoved if it counts in another.
void RequireEspUnit(DeviceLine& line, const std::string& axis, int unit);

/// Commands with the query of their errors, for Dialogue::IntroduceBy: the token of a served twin, and a watchdog as the bench file words it.
/// @param token, watchdog  Empty: none.
std::vector<std::string> EspIntroductions(const std::string& token, const std::string& watchdog);

/// The answer to a query that the controller may not know: one that it does not know is not answered, so what comes first then is the
/// answer to the next.
std::optional<std::string> EspAnswerTo(DeviceLine& line, const std::string& query);

}  // namespace twinbench::hw
