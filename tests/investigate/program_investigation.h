#pragma once

#include <cstdint>
#include <string>

#include "tests/investigate/hidden_investigation.h"

namespace twinbench::investigate {

/// An encoder that a program measures (tests/data/program/acquire_hidden.py), which shares nothing with the twin.
/// @param script  The program's path.
/// @param folder  Where its files go.
Judged InvestigateProgram(const std::string& script, std::uint64_t seed, const std::string& folder);

}  // namespace twinbench::investigate
