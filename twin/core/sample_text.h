#pragma once

#include <string>
#include <vector>

#include "twin/core/machine.h"

/// The answers of a machine and its instruments as text. Private to machine_call.cc and asked_machine.cc.
namespace twinbench {

/// One line an axis.
std::string StatesText(const std::vector<AxisState>& states);
std::vector<AxisState> ParseStates(const std::string& text);

/// Lower and upper of every axis.
std::string TravelText(const std::vector<AxisLimits>& travel);
std::vector<AxisLimits> ParseTravel(const std::string& text);

/// Time, status, and name and number (SI) of every column in `shown` that has one.
std::string SampleText(const Reading& sample, const std::vector<ReadingColumn>& shown);
/// @throws InputError for a text that is none, or a column that is not in `shown`.
Reading ParseSample(const std::string& text, const std::vector<ReadingColumn>& shown);

/// Whether some are lost, then a line a sample.
std::string LatchedText(const LatchedSamples& latched, const std::vector<ReadingColumn>& shown);
LatchedSamples ParseLatched(const std::string& text, const std::vector<ReadingColumn>& shown);

}  // namespace twinbench
