#pragma once

#include <array>

#include "twin/core/table_errors.h"
#include "twin/diagnose/by_twin.h"

/// What enters at a point of the twin: effects of a catalogue as its slopes there times a course of one shape, and what
/// a table draws anew at every stop.
namespace twinbench::diagnose {

/// A wave along a coordinate whose period is not known: sizes are those of its cosine and its sine.
/// @param along  The coordinate of a reading; periods are in its unit.
TwinComparison::Product WaveAlong(const std::string& effect, const std::string& where, const std::string& point,
                                  const std::string& period, std::function<double(const Reading&)> along,
                                  double shortest, double longest);

/// "step" at a point from "at_reading" on, with a few readings of its set-up before and behind it.
TwinComparison::Product SlipAt(const std::string& where, const std::string& point);

/// 0, and from shorter than a room needs to longer than a machine does.
std::vector<double> TemperatureLags_s();

/// `size` times the temperature above the reference, which the point follows with a "lag".
TwinComparison::Product FollowsTemperature(const std::string& effect, const std::string& where,
                                           const std::string& point, const std::string& size,
                                           double reference_degC);

/// At the points "table.ex" to "table.dz", by the table's repeatability.
std::vector<TwinComparison::Scatter> RepeatabilityOf(const std::string& table,
                                                     const std::array<double, kComponents>& sd);

}  // namespace twinbench::diagnose
