#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace twinbench::report {

/// JSON that somebody else may have written or damaged.
/// @param name  Of the file, for messages.
/// @throws InputError if it is none, or is nested deeper than anything of ours: what goes through it again goes down as deep.
nlohmann::json ParseModestJson(const std::string& text, const std::string& name);

inline constexpr int kDeepestJson = 100;

}  // namespace twinbench::report
