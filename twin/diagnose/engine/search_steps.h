#pragma once

#include <functional>
#include <vector>

#include "twin/diagnose/engine/search.h"
#include "twin/diagnose/engine/take_best.h"

/// What a search is made of: terms are added, selected again, and dropped.
namespace twinbench::diagnose {

/// Adds the most probable of what is left until nothing is, or there is no more room.
void Forward(const SearchProblem& problem, SearchResult& result);

/// Drops what the others have made needless, one at a time: two that stand for the same thing need not both go.
void Revise(const SearchProblem& problem, SearchResult& result);

using IsOneOf = std::function<bool(const Family&)>;

bool IsUnknown(const Family& family);
bool HasAny(const SearchProblem& problem, const std::vector<Term>& terms, const IsOneOf& is_one);

/// The search in which such families do not exist.
SearchProblem Without(SearchProblem problem, const IsOneOf& is_one);

}  // namespace twinbench::diagnose
