#pragma once

#include <string>

namespace twinbench {

/// A scenario file of a bench in which every key stands with its default, its meaning and its bounds, commented out: it
/// says what the defaults say until somebody takes a # away.
/// @throws InputError if there is no such bench.
std::string WriteExplained(const std::string& bench);

}  // namespace twinbench
