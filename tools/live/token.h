#pragma once

#include <string>
#include <string_view>

namespace twinbench::live {

/// 256 random bits of the system as 64 hexadecimal digits: whoever knows them may see the page and stop the measurement.
std::string NewToken();

/// Takes as long for any `asked`, however much of it is right.
bool IsToken(std::string_view asked, std::string_view token);

}  // namespace twinbench::live
