#pragma once

#include <string>

#include "twin/core/errors.h"

namespace twinbench {

/// The refusal of a file or folder of which nothing can be read: it does not exist, is a folder, is empty, or may not be read. If one of nearly
/// that name is beside it, or among the shipped scenarios, it is named.
/// @param named  What the message begins with; empty: the path.
InputError NothingToRead(const std::string& path, const std::string& expected, const std::string& named = "");

/// What would be right, and behind it the file or folder that was probably meant by a path that does not exist.
std::string OrNearestFile(const std::string& expected, const std::string& path);

}  // namespace twinbench
