#pragma once

#include <string>

namespace twinbench {

/// No input is larger than this: so large a file is a device, a raw recording of something else, or a mistake.
inline constexpr std::size_t kLargestInput_B = std::size_t{256} << 20;

/// All bytes of a file that somebody names.
/// @param expected  What would be right, for the message.
/// @param where     What the message begins with; empty: the path.
/// @throws InputError if it cannot be read, is empty, or is larger than kLargestInput_B (/dev/zero has no end).
std::string InputText(const std::string& path, const std::string& expected, const std::string& where = "");

}  // namespace twinbench
