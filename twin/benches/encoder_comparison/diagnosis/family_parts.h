#pragma once

#include <memory>
#include <string>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/diagnose/engine/time_series.h"
#include "twin/diagnose/unknown/design.h"

/// What the makers of families have in common; only families.cc, named_families.cc and unknown_families.cc need it.
namespace twinbench::diagnose::encoder {

using Context = std::shared_ptr<const SignalContext>;
/// Every effect of the catalogue that leaves a trace.
/// @param plausible_rad  Size of a trace in the readings that is worth a candidate.
std::vector<Family> NamedFamilies(const Context& context, const TimeSeries& series, double plausible_rad);

/// Counts that get lost, or come, at one angle of the device each time that it is passed.
std::vector<Family> LostCountFamilies(const SignalContext& context, const unknown::Design& design);

/// Bits of an absolute code that are worth something else than they should: dead, stuck, tied to another or exchanged with it.
/// Only those whose edges show.
std::vector<Family> CodeDigitFamilies(const EncoderRun& encoder, const unknown::Design& design);

/// Readings that stay where the range of the device ends.
std::vector<Family> RangeEndFamilies(const EncoderRun& encoder, const unknown::Design& design);

/// Structure without a name.
std::vector<Family> UnknownFamilies(const EncoderRun& encoder, const TimeSeries& series, double plausible_rad);

}  // namespace twinbench::diagnose::encoder
