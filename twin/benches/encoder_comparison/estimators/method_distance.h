#pragma once

#include <string>

#include "twin/separate/series.h"

/// A published estimator against the rigorous one from the same readings.
namespace twinbench::separate::encoder {

/// Widens the covariance of each order by its distance to the rigorous result, where that is more than
/// noise makes of it: above twice its size, and once in 50 spectra by chance.
/// @return the orders that were widened, as a list.
std::string WidenByDistance(const harmonics::HarmonicSeries& rigorous, harmonics::HarmonicSeries& published);

std::string BiasNote(const std::string& orders);

}  // namespace twinbench::separate::encoder
