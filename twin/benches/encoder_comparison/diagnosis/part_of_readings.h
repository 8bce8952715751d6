#pragma once

#include <vector>

#include "twin/core/reading.h"

namespace twinbench::diagnose::encoder {

/// Some 4000 of 6000 readings and more, those of fewer all: a search that takes ten seconds of them would take a
/// minute of 20 000, and finds what is half as large.
///
/// They are taken in groups of neighbours at uneven distances, so that distances, speeds and the usual step stay what they are
/// and orders far above each other are told apart. Every pass begins with its first reading, so that what remembers the way still
/// finds where it turned: play and hysteresis do not care how many readings lie on a way that goes on.
///
/// @param events  Reading numbers at which something happens once: about them all readings are taken.
std::vector<Reading> PartOf(const std::vector<Reading>& readings, const std::vector<double>& events = {});

}  // namespace twinbench::diagnose::encoder
