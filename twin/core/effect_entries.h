#pragma once

#include "twin/core/effect_catalogue.h"

/// How the entries of the catalogue are written down; only the catalogues of the benches need this.
namespace twinbench {

/// A parameter whose default and bounds are given in `unit`.
EffectParameter Parameter(const std::string& name, const std::string& unit, double value, double lower,
                          double upper, const std::string& meaning, std::vector<std::string> only_at = {});

/// A parameter that may have either sign.
EffectParameter Signed(const std::string& name, const std::string& unit, double value, double limit,
                       const std::string& meaning, std::vector<std::string> only_at = {});

/// The parts of a bench's catalogue, one behind another.
inline std::vector<EffectEntry> Joined(std::initializer_list<std::vector<EffectEntry>> parts) {
  std::vector<EffectEntry> entries;
  for (const auto& part : parts) entries.insert(entries.end(), part.begin(), part.end());
  return entries;
}

}  // namespace twinbench
