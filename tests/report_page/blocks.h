#pragma once

#include <fstream>
#include <nlohmann/json.hpp>

#include "twin/report/page/figure.h"

namespace twinbench::report::test {

/// A file of tests/data/pages.
inline nlohmann::json JsonOf(const std::string& name) {
  return nlohmann::json::parse(std::ifstream(std::string(TWINBENCH_TEST_DATA "/pages/") + name));
}

/// All blocks of one kind, in their order.
template <class Block>
std::vector<Block> BlocksOf(const std::vector<PageSection>& sections) {
  std::vector<Block> found;
  for (const PageSection& section : sections) {
    for (const PageBlock& block : section.blocks) {
      if (const auto* one = std::get_if<Block>(&block)) found.push_back(*one);
    }
  }
  return found;
}

}  // namespace twinbench::report::test
