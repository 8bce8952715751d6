#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Records of a program's log in which every quantity has a line: "Order given: [0.1, -0.2, 0.3]" above "Actual position: [...]".
namespace twinbench::imports {

/// True where lists of numbers under two names and more come again and again.
bool AreNamedLists(const std::vector<std::string_view>& lines);

/// A row a record, tabs between fields: "Order given.0", "Order given.1", ... as records in JSON have them, and what else has a
/// name and one value, such as a time stamp. A record ends where a name comes again. Other lines stay as they are.
std::string TableOfNamedLists(std::string_view text);

}  // namespace twinbench::imports
