#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "twin/core/errors.h"

namespace twinbench {

/// How many letters must be inserted, left out, replaced or swapped with their neighbour to turn `a` into `b`.
/// Reference: optimal string alignment form of Damerau, CACM 7 (1964) 171-176.
int EditDistance(std::string_view a, std::string_view b);

/// @return the first of `known` with the least distance to `word`; empty if there is none.
std::string Nearest(std::string_view word, const std::vector<std::string>& known);

/// A key as it should have been written: table, name, unit.
struct KnownKey {
  std::string table;   // empty at the top
  std::string name;    // without unit
  std::string suffix;  // the unit; empty without

  std::string Key() const { return suffix.empty() ? name : name + "_" + suffix; }
  std::string Path() const { return table.empty() ? Key() : table + "." + Key(); }
};

/// The refusal of a key that is not `known`: it names the key with the right unit, the same key of another table,
/// or the nearest one.
/// @param where  File and line of `key`, which stands in `table`.
InputError UnknownKey(const std::string& where, const std::string& table, const std::string& key,
                      const std::vector<KnownKey>& known);

}  // namespace twinbench
