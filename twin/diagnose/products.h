#pragma once

#include "twin/diagnose/by_twin.h"

/// Effects of a catalogue as slopes of the twin at a point times a course of one shape.
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

}  // namespace twinbench::diagnose
