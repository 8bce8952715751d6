#pragma once

#include <string>

namespace twinbench {

/// Refuses text that a TOML reader would spend its stack or the user's patience on, before it is read: keys of more than
/// kLongestKey letters or kMostParts parts.
/// @throws InputError with the line.
void RequireModestKeys(const std::string& text, const std::string& name);

inline constexpr int kLongestKey = 1024;
inline constexpr int kMostParts = 64;

}  // namespace twinbench
