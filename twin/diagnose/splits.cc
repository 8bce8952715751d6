#include "twin/diagnose/splits.h"

#include <algorithm>

namespace twinbench::diagnose {

std::string WhatSplits(const std::vector<Split>& splits, const std::string& effect, const std::string& rival,
                       const std::string& otherwise) {
  for (const Split& split : splits) {
    const auto has = [&split](const std::string& name) { return std::ranges::count(split.effects, name) > 0; };
    const bool alone = split.effects.size() == 1;
    if (alone ? has(effect) || has(rival) : has(effect) && has(rival)) return split.words;
  }
  return otherwise;
}

}  // namespace twinbench::diagnose
