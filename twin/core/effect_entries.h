#pragma once

#include "twin/core/effect_catalogue.h"

/// How the entries of the catalogue are written down; only its own files need this.
namespace twinbench {

/// A parameter whose default and bounds are given in `unit`.
EffectParameter Parameter(const std::string& name, const std::string& unit, double value, double lower,
                          double upper, const std::string& meaning, std::vector<std::string> only_at = {});

/// A parameter that may have either sign.
EffectParameter Signed(const std::string& name, const std::string& unit, double value, double limit,
                       const std::string& meaning, std::vector<std::string> only_at = {});

/// Effects of the benches encoder_comparison, turntable_autocollimator and hob_transmission.
std::vector<EffectEntry> EncoderEffects();
std::vector<EffectEntry> TurntableEffects();
std::vector<EffectEntry> HobEffects();

}  // namespace twinbench
