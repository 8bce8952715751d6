#pragma once

#include <vector>

#include "twin/benches/hob_transmission/estimators/turns.h"

namespace twinbench::separate::hob {

/// Takes waves of the hob's own angle out of one pass, which are no whole orders of the table's turn and would scatter
/// from turn to turn. They are fitted to all turns of the pass together, beside the orders of the table and a drift.
/// @param pass  Is left without them.
/// @return those that the pass tells from the orders of the table: a half order takes two turns.
///
/// Uncertainty: white noise about that fit.
std::vector<HobOrder> TakeHobOrders(const TransmissionOptions& options, Pass& pass);

/// Of several passes, places of the head or directions: the mean of each order that all of them have.
std::vector<HobOrder> MeanOf(const std::vector<std::vector<HobOrder>>& all);

}  // namespace twinbench::separate::hob
