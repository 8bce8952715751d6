#pragma once

#include <vector>

#include "twin/diagnose/diagnosis.h"

/// What the errors of held-out predictions say of a gain.
namespace twinbench::diagnose {

/// Sums over held-out rows; squares in units of the noise that is stated for each row.
struct HeldOutSums {
  double before = 0.0, after = 0.0;  // squared errors of the predictions
  double floor = 0.0;                // what `after` would be if the causes were known exactly
  double weight = 0.0;               // sum of 1 / sigma^2 [1 / SI^2]
  double steps = 0.0, pairs = 0.0;   // half the squared differences of neighbours' errors after, and their number
  double fold_sizes = 0.0;           // what the uncertainty of a fold's sizes adds to `after`, and
  double all_sizes = 0.0;            // what that of the sizes from all readings would add, which the file has

  HeldOutSums& operator+=(const HeldOutSums& other);
};

/// Fills in what follows from the sums of independent blocks.
///
/// With N = before - after, what was removed, and R = after - floor, what remains to be removed,
///     fraction_removed = N / (N + R) = f(R / N),   f(q) = 1 / (1 + q), and its tangent 1 - q below zero.
/// R is a difference of two large sums and N is not: where the causes are small, R / N is uncertain and may come
/// out below zero by chance, and the fraction above 1. Nothing is cut off there, because a mean over many runs
/// would then be too large or too small. That f is curved makes the mean of f larger than f of the mean; the
/// bootstrap says by how much, and that is taken off. The interval is of the draws: paired bootstrap over the
/// blocks, 1000 draws from Stream(1, "diagnose.gain"). `positive`: N is above zero in 97.5 % of the draws. Without
/// a positive gain the fraction is plainly N / (N + R), NaN where N + R is not above zero.
///
/// another_run is what is to be expected of the file on another run. R scatters by its bootstrap deviation, which may be
/// a good part of N, while the sizes' own uncertainty says what a model that is right leaves. So R is taken as that
/// and something that is not modelled, U: nothing with the probability of a listed cause (tuning.h), else of any size
/// (uniform in its logarithm, up to where the R that was found excludes it), whichever that R makes more likely; its mean is what is expected.
///
/// @param noise_is_stated  If not, the stated noise is an estimate, and its error would count as something removed
/// or
///                         left. The floor is then scaled by what neighbouring errors differ by, in every draw
///                         anew: what changes from reading to reading counts as noise.
/// @param correlation      Of the noise of neighbours, by which their differences are smaller.
void FillGain(const std::vector<HeldOutSums>& blocks, bool noise_is_stated, double correlation, Gain& gain);

}  // namespace twinbench::diagnose
