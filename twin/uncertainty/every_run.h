#pragma once

#include <string>
#include <string_view>

#include "twin/uncertainty/quantities.h"

/// What is the same in every run of one bench, so that no number of runs averages it.
namespace twinbench::uncertainty {

/// A part of type B that is another one in every reading.
inline constexpr std::string_view kRoundingOfReadings = "quantisation";

/// Parts that are of type B (GUM): known of an instrument or a model, not seen to scatter.
bool IsNotByStatistics(const std::string& part);

/// All of these but the rounding of readings.
bool IsSameInEveryRun(const std::string& part);

/// Of u^2, what another run has anew; all of it where the parts are not told apart.
double OwnShare(const Quantity& quantity);

/// Whether it is the same number in another run: what belongs to one mounting is new at the next.
bool OutlastsTheRun(const std::string& quantity);

}  // namespace twinbench::uncertainty
