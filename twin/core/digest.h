#pragma once

#include <string>

namespace twinbench {

/// SHA-256 as 64 hexadecimal digits (FIPS 180-4).
std::string Sha256(const std::string& bytes);

}  // namespace twinbench
