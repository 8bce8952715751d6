#pragma once

#include <string>
#include <vector>

#include "twin/benches/hob_transmission/diagnosis/signals.h"
#include "twin/core/reading.h"
#include "twin/model/follow.h"

/// The forward model of a hobbing machine's transmission chain with a ring encoder at either end (Tan et al.), with
/// the effects that the scenario already knows.
namespace twinbench::diagnose::hob {

/// Samples that are far from both of their neighbours' levels: disturbed for no lasting reason, and left out.
struct Outliers {
  std::vector<int> readings;  // running numbers
  double size_rad = 0.0;      // rms
  double log_bayes = 0.0;     // against white noise
  int of = 0;                 // samples that were looked at
};

struct HobRun {
  LinearRun run;  // "transmission", and "interferometer" where it was recorded; in arcsec
  SignalContext context;
  Outliers outliers;
  int left_out = 0;               // readings without a value
  double second_order_rad = 0.0;  // rms of what the forward model may leave out of m
};

/// m = table encoder - ratio x hob encoder is a free error of the transmission, of orders 1 to
/// transmission.free_orders by turns of the table and the same in every set-up, a constant of each set-up, and what
/// the scenario states. The interferometer sees the same free error.
///
/// Rows are means over groups of neighbouring samples, as many as leave the worm and the mesh four fifths of their
/// size. Noise as stated by the encoders; where they state none it is estimated from neighbours and from turns.
///
/// Second order: gears and rings err at angles that are themselves in error by m. What varies faster than the free
/// orders, times the order of worm or mesh, times m: a percent of an arcsecond, which a quiet interferometer sees.
///
/// @param follow  The twin that is asked what readings should have been, with the free orders that fit best.
/// @throws InputError if fewer than 12 readings have a value, or one has no head angle.
HobRun BuildRun(const std::vector<Reading>& readings, const Scenario& scenario, const model::FollowMaker& follow);

/// What unknowns that follow a cause would do to the results: "transmission order 1 up to 4.9 arcsec".
std::string BiasInWords(int free_orders, const Eigen::VectorXd& unknowns);

/// Largest order by turns of the table that the rows can tell from lower ones; at most 120.
int LargestOrder(const SignalContext& context);

/// Typical way of the table from one row to the next [rad].
double RowSpacing_rad(const SignalContext& context);

}  // namespace twinbench::diagnose::hob
