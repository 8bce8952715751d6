#pragma once

#include <nlohmann/json.hpp>

#include "twin/benches/hob_transmission/estimators/hob_bench.h"
#include "twin/benches/hob_transmission/settings.h"

namespace twinbench::benches::hob {

/// Variance of a sample by the steps in which the rings count: that of the hob as it counts in the table's angle,
/// and at rest, where no edge of the table's ring is waited for, that of the table as well [rad^2].
double StepVariance_rad2(const HobSettings& settings, bool is_at_rest);

/// `u_parts` of a series that is made of these positions, lists by order: noise of the samples about the fits of
/// their turns, of it what steps of the counts make, what scatters from turn to turn beyond that, the drift of the
/// passes, and the second order of the model where heads are told apart. Positions count alike.
nlohmann::json PartsOf(const std::vector<const separate::hob::PositionError*>& positions, double of_steps_rad2,
                       bool with_second_order);

/// The same of a series whose variance has that of a calibrator besides.
/// @param parts  Without it.
nlohmann::json WithStandard(nlohmann::json parts, const separate::hob::HarmonicSeries& series, double u_standard_rad,
                            const std::vector<double>& rounding_rad2 = {});

/// Of one order of two series that share nothing: of the difference of their amplitudes, or of their phases.
struct ComparedParts {
  nlohmann::json estimated, reference;  // PartsOf
};
nlohmann::json PartsOf(const separate::hob::OrderComparison& comparison, const ComparedParts& parts);

/// One order of lists by order: numbers.
nlohmann::json PartsOfOrder(const nlohmann::json& parts, int order);

}  // namespace twinbench::benches::hob
