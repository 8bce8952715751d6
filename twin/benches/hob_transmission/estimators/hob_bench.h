#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "twin/benches/hob_transmission/estimators/comparison.h"
#include "twin/benches/hob_transmission/estimators/two_positions.h"
#include "twin/core/estimator.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"

/// From readings of the bench hob_transmission to all that is reported of them.
namespace twinbench::separate::hob {

/// Readings with numbers, as samples.
std::vector<HobSample> SamplesOf(const std::vector<Reading>& readings);

/// One direction of travel.
struct DirectionResult {
  int direction = 1;
  HarmonicSeries transmission;                          // e_T
  std::vector<int> lines;                               // orders that noise would not show
  std::vector<HobOrder> of_hob;                         // likewise, of the hob's turn, that are no such orders
  std::vector<OrderComparison> against_interferometer;  // empty without one
};

struct HobAnalysis {
  Estimator estimator = Estimator::kRigorous;
  int used = 0, left_out = 0;
  std::vector<PositionError> positions;       // what each head showed, by direction
  std::optional<HeadSeparation> separation;   // rigorous
  std::map<int, int> folded;  // orders as which the samples show one of hob, gear or worm wheel, and that
  std::optional<TwoPositions> two_positions;  // published: the first two heads, in the first direction of both
  std::vector<DirectionResult> directions;
  HarmonicSeries encoder;                        // psi in the encoder's own angle; orders not seen are NaN
  HarmonicSeries encoder_by_interferometer;      // empty without one
  std::vector<double> encoder_rounding_rad2;  // [k - 1]: of its variance (mean of both parts), what steps repeat at stops
  std::vector<PositionError> by_interferometer;  // what that is a mean of
  std::vector<PositionError> transmission_by_interferometer;  // empty without one, and where it is read at rest
  std::vector<OrderComparison> encoder_against_interferometer;
  /// The same with the first place of the head alone, as published: errors of the interferometer that go with the
  /// table are in it, where the mean over the places turns them against each other.
  HarmonicSeries encoder_by_one_place;
  std::vector<PositionError> by_one_place;
  std::vector<OrderComparison> encoder_against_one_place;
  bool is_interferometer_at_rest = false;  // read from stop to stop, with one place of the head
  std::string not_separated;               // why there is no separation
};

/// The first two set-ups that have turns in one direction, which `two_positions` is made of; empty without two.
std::vector<const PositionError*> FirstTwoOf(const std::vector<PositionError>& positions);

/// @throws InputError as MeasurePositions.
/// Reference: Tan et al., equations 1 and 13 to 15 (published); SeparateHeads (rigorous).
HobAnalysis AnalyseHob(const std::vector<Reading>& readings, const Scenario& scenario, Estimator estimator);

}  // namespace twinbench::separate::hob
