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

}  // namespace twinbench
