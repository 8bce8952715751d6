#pragma once

#include <string>
#include <vector>

#include "hw_bridge/serve/iiod_devices.h"

namespace twinbench::hw {

/// Which attributes the words of a READ or WRITE after the device speak of.
struct IiodTarget {
  const IiodAttributes* attributes = nullptr;  // nullptr: no such channel
  std::string name;                            // empty: all of them
};
/// @param words  Of the command, from the one after the device on: "[DEBUG | BUFFER] [<attr>]" or
///               "INPUT | OUTPUT <channel> [<attr>]".
IiodTarget FindIiodTarget(const IiodDevice& device, const std::vector<std::string>& words);

/// Answers to READ: `<len>\n<value bytes with a NUL>\n`, or `-errno\n`.
std::string ReadIiodAttributes(const IiodTarget& target);
/// Answers to WRITE: the number of bytes taken, or -errno.
int WriteIiodAttribute(const IiodTarget& target, std::string value);

}  // namespace twinbench::hw
