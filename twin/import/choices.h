#pragma once

#include <set>
#include <string>
#include <vector>

#include "twin/import/map.h"
#include "twin/import/recording.h"

/// Columns of files that a guess may take for a quantity of the bench.
namespace twinbench::imports {

struct Choice {
  std::string name;  // as an expression has it
  const Column* column = nullptr;
  const Track* track = nullptr;
  const Recording* recording = nullptr;
};

/// Columns of numbers, each under a name that is its own.
std::vector<Choice> NumberColumns(const std::vector<Recording>& recordings);

/// A column that never changes is nobody's reference and no device: it is not guessed to be one.
bool Changes(const Choice& choice);

/// 0, 1, 2, ...: the number of a row, where nobody says what it is.
bool IsCounter(const Column& column);

bool IsGiven(const Map& map, const std::string& column);

/// What the map takes a column of the bench from; empty if nothing.
std::string GivenExpression(const Map& map, const std::string& column);

/// Columns that the map takes already.
std::set<std::string> Taken(const Map& map);

/// A unit that can stand for the column's, or nothing.
std::string UnitFor(const Column& column, const std::string& target);

bool StaysWithin(const Column& column, double limit);

/// Takes a column for a quantity of the bench and says so where something was guessed: the column itself (`why`), its unit,
/// or how many of its counts make a turn.
/// @throws InputError if it has a unit that is known to be none of an angle or a length, or is not known at all.
void Put(const std::string& target, const Choice& from, const std::string& why, Map& map,
         std::vector<std::string>& remarks);

}  // namespace twinbench::imports
