#pragma once

#include <vector>

#include "twin/benches/hob_transmission/estimators/sample.h"
#include "twin/separate/position_error.h"

namespace twinbench::separate::hob {

/// What to follow over the turn.
enum class Signal {
  kEncoders,                     // m = table encoder - ratio x hob encoder (equation 1)
  kInterferometer,               // transmission error as the interferometer sees it
  kEncodersMinusInterferometer,  // the encoder's own error psi(th - head), without assumption
};

struct TransmissionOptions {
  double table_turns_per_hob_turn =
      2.0 / 44.0;  // starts of the hob / teeth of the gear; negative: counted contrary
  EncoderZero zero = EncoderZero::kTableOrigin;
  int max_order = 100;  // per turn of the table; the samples of a turn must be more than twice as many
  std::vector<int> hob_orders = {};  // of the hob's turn, that are no whole orders of the table's, or higher ones
  double hob_step_rad = 0.0;  // in which the hob's encoder counts, as the table turns meanwhile; 0: none
  /// A turn is left out if gaps make an order's variance larger than this many times that of regular samples.
  double max_inflation = 4.0;
  /// The scatter of an order is pooled with that of this many orders on either side: few turns say little about one
  /// order. What scatters in one order only is then understated; 0 takes each order by itself.
  int pooled_orders = 4;
};

/// Takes one signal of each set-up and direction apart into the orders of the table's turn.
///
/// Every turn is fitted by itself where its samples are (FitTurn), so nothing is interpolated. Their mean is the
/// result, Resample(series, n) its values at regular angles. A steady drift over the passes of three turns and
/// more in a row, from the means of the turns, is taken out before; it would show with the amplitude drift / (pi k)
/// in every order k.
///
/// @return ascending set-up, direction +1 before -1; those without samples are not there.
/// @throws InputError if a direction is neither +1 nor -1, if the head angle is missing or changes within a set-up,
///         or if the signal wanders by more than 0.1 rad within a pass: an angle that wraps, or another ratio.
///
/// Uncertainty: scatter between turns, the same for both phases of an order, and that of the drift; with a single
/// turn that of white samples about the fit; what coarse counts of the hob repeat in every turn; and, of few
/// samples a turn, what higher orders fold onto those that are fitted. Not included: what repeats there besides
/// (the encoders' errors: that of the hob spindle's `ratio` times, equation 2), the table's angle being known to
/// the error of its encoder only (order k: its amplitude times k psi, relative).
std::vector<PositionError> MeasurePositions(const std::vector<HobSample>& samples,
                                            const TransmissionOptions& options, Signal signal = Signal::kEncoders);

}  // namespace twinbench::separate::hob
