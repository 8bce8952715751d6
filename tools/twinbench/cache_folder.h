#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace twinbench::tools {

/// `--cache`: where thresholds that were calibrated are kept.
void AddCache(CLI::App& command, std::string& folder);

/// The folder of the calibrations, made if it is not there; nothing, with a note, where that cannot be.
/// @param asked  By the user; empty: in the user's cache.
std::string CacheFolder(const std::string& asked);

}  // namespace twinbench::tools
