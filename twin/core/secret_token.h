#pragma once

#include <string>
#include <string_view>

/// Who may change something that others may see: whoever was told.
namespace twinbench {

/// 256 random bits of the system as 64 hexadecimal digits.
/// @throws BenchError if the system gives none.
std::string NewToken();

/// Takes as long for any `asked`, however much of it is right.
bool IsToken(std::string_view asked, std::string_view token);

}  // namespace twinbench
