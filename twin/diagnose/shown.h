#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/diagnose.h"

namespace twinbench::diagnose {

/// What the believed scenario leaves of the readings of one channel along the course, forward and backward: means
/// at each place. Where more than kCurvePlaces places were visited, of as many equal parts of the way.
struct ErrorCurve {
  std::string channel;                    // where the residual is largest, in units of its noise
  std::string unit;                       // of the values: "deg"
  std::string along, along_unit;          // "angle" [deg] within one turn, "position" [mm], "reading" []
  std::vector<double> x;                  // ascending
  std::vector<double> forward, backward;  // one a place; NaN where there was no such reading
  bool is_directed = true;                // false: no reading has a direction, `forward` holds all of them
};
inline constexpr int kCurvePlaces = 68;

/// How much of the readings' variance each cause explains, and what there is to be explained.
///
/// With y the residual of the believed scenario, W what takes out the free unknowns, and s_k the signature of accepted
/// term k in its fitted size, all terms fitted together and all rows in units of their own noise,
///
///     share_k = s_k' W y / max(y' W y - dof, sum of s_j' W y)
///
/// What noise remembers is not taken out: it would make a slow cause, of which the readings show most, look small.
/// The first denominator is the variance beyond noise; a small cause in many readings is less than its own
/// uncertainty, then the second bounds the sum by 1. Shares of causes that overlap add up, whatever their order;
/// one of them may come out negative.
struct Shown {
  std::vector<double> share;    // of each of the diagnosis' causes; NaN for one that was not fitted to residuals
  double share_unnamed = kNaN;  // of all structure without a name; NaN if none was fitted
  ErrorCurve curve;
};
Shown ShownBy(const DiagnosisRun& found);

/// So large an order comes by chance, from noise alone, in fewer than 1 of 100 such tables.
bool IsSignificant(const Harmonic& harmonic, std::size_t orders);

}  // namespace twinbench::diagnose
