#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace twinbench::fuzz {

/// Input number `number` that is made of the seeds: the same for the same arguments on every machine. One to eight changes of a seed:
/// bits, bytes, pieces left out, doubled, moved or taken from another seed, numbers and separators that readers stumble over.
/// @param seeds  Not empty.
std::string Mutated(const std::vector<std::string>& seeds, std::uint64_t number);

}  // namespace twinbench::fuzz
