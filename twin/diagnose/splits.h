#pragma once

#include <string>
#include <vector>

namespace twinbench::diagnose {

/// What tells causes apart that a run cannot: the same words for any two of some effects, or for one effect alone
/// and whatever its rival.
struct Split {
  std::vector<std::string> effects;
  std::string words;
};

/// The words of the first that fits; else `otherwise`.
std::string WhatSplits(const std::vector<Split>& splits, const std::string& effect, const std::string& rival,
                       const std::string& otherwise);

}  // namespace twinbench::diagnose
