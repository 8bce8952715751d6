#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "twin/import/map.h"
#include "twin/import/recording.h"

namespace twinbench::imports {

/// True of a text that begins as JSON does: {"..., [{..., [[...
bool OpensRecords(const std::vector<std::string_view>& lines);

/// Records that a program wrote down in JSON: a list of objects, alone or anywhere in an object; an object a line; an
/// object of lists of one length; a list of lists. What an object holds further down has the names with a dot between
/// ("state.position"), an entry of a list its number ("position.0"). Single numbers beside the list are named numbers.
/// @throws InputError if the text is no JSON or has no such records.
void ReadRecords(std::string_view text, const Layout& layout, const ClockSettings& clock, Recording& recording);

}  // namespace twinbench::imports
