#pragma once

#include <vector>

#include "twin/core/reading.h"

namespace twinbench::diagnose {

/// What is wanted of a part of the readings.
struct PartWanted {
  std::vector<double> events = {};  // reading numbers at which something happens once: about them all readings are taken
  std::size_t enough = 4000;        // readings, beside those about events
  std::size_t about = 0;            // readings on either side of an event; 0: as many as two groups that are taken lie apart
};

/// Some `enough` of half as many again and more, those of fewer all: a search that takes ten seconds of 4000 would take a
/// minute of 20 000, and finds what is half as large.
///
/// They are taken in groups of neighbours at uneven distances, so that distances, speeds and the usual step stay what they are
/// and orders far above each other are told apart. Every pass begins with its first reading, so that what remembers the way still
/// finds where it turned: play and hysteresis do not care how many readings lie on a way that goes on.
std::vector<Reading> PartOf(const std::vector<Reading>& readings, const PartWanted& wanted = {});

}  // namespace twinbench::diagnose
