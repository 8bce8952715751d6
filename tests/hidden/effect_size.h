#pragma once

#include <string>
#include <vector>

#include "tests/hidden/bench_runs.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/stream.h"

/// How large an effect is: the parameter that says so, and the length of its signature in units of noise.
namespace twinbench::hidden {

/// An effect with the sizes of the catalogue.
EffectSettings WithDefaults(const std::string& name, const std::string& where, const std::string& bench);

/// An effect of the catalogue with a shape and a sign drawn at random. Its size is the plausible one of the
/// catalogue; SizedTo brings it to what a case wants.
///
/// @param where  One of the effect's places; empty if it has none.
EffectSettings DrawEffect(const std::string& name, const std::string& where, const Scenario& scenario,
                          Stream& stream);

/// The parameter that an effect's signature grows with, in the catalogue the first that is not of a wave; empty if
/// it has no size.
std::string SizeParameter(const std::string& effect, const std::string& where, const std::string& bench);

/// Effects that leave a trace proportional to a size; the others (a swap, a frame) are there or not, or, as
/// outliers, come with a size of their own.
bool HasSize(const std::string& effect, const std::string& where, const std::string& bench);

/// Gives a wave that is stated by cosine and sine this phase; other effects stay.
void TurnWave(double phase_rad, const std::string& bench, EffectSettings& effect);

/// @param name  One of the effect's parameters.
const EffectParameter& CatalogueParameter(const std::string& bench, const std::string& effect,
                                          const std::string& name);

/// Readings of the bench without noise and with nothing but these effects.
std::vector<Reading> NoiseFree(Scenario scenario, const std::vector<EffectSettings>& effects);

/// The effect with its signature brought to the length `rho`, or to what the catalogue's bounds allow of it.
///
/// @param effect  With a size.
/// @param drawn   The bench of the case.
EffectSettings SizedTo(double rho, EffectSettings effect, const Scenario& drawn, const SignatureScale& scale);

}  // namespace twinbench::hidden
