#pragma once

#include "tests/hidden/bench_runs.h"
#include "twin/core/effect_catalogue.h"

namespace twinbench::hidden {

/// An effect of the catalogue at one of its places, in a design that can show it.
struct Placement {
  std::string effect, where;
  Design design;
};

/// Every effect, place and design of a bench, in the order of the catalogue.
std::vector<Placement> Placements(const std::string& bench);

/// The designs of a bench without anything stated that few know.
std::vector<Design> PlainDesigns(const std::string& bench);

/// "rotary:psd_gain:psd_a_x:17": unique, and says what to expect before the case is made.
std::string CaseName(const Placement& placement, std::uint64_t seed);

/// Effects that the readings of a case cannot tell from this one, itself included.
///
/// @param drawn  The bench of the case.
std::vector<std::string> AlikeOf(const EffectSettings& effect, const Scenario& drawn, const SignatureScale& scale);

/// A place of `convention` that only relabels the positions: free errors of both tables are the same under other
/// labels.
bool OnlyRelabels(const std::string& where);

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
