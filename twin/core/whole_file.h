#pragma once

#include <string>

namespace twinbench {

/// Writes beside the file and renames, so that whoever reads it, also after a power failure, has the old file or the new one,
/// never half of one. A link stays one. What is no file (a pipe, a device) is written to.
/// @throws BenchError if the disk refuses; nothing is left beside then.
void WriteFileAtOnce(const std::string& path, const std::string& text);

/// The bytes of a file; empty if it cannot be read.
std::string BytesOfFile(const std::string& path);

}  // namespace twinbench
