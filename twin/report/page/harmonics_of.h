#pragma once

#include <optional>

#include "twin/report/page/figure.h"

namespace twinbench::report {

/// Adds the line below which noise alone stays with 95 % probability: cosine and sine part of an amplitude scatter by its u, so their root of the
/// sum of squares has Rayleigh's distribution. Of several series the largest; none without a u.
void AddNoiseLimit(Figure& spectrum);

/// What a curve at equal steps of a full circle is made of: a picture of the numbers that it shows, no estimate of its own.
///
/// @param curve  A figure of form kAngle.
/// @return amplitudes of orders 1 .. (n - 1)/2 of every series that goes round at n >= 8 equal steps without a gap; nothing if none
///         does. With the limit of noise; where no u of the orders is stated, that of points that are independent of each other.
std::optional<Figure> HarmonicsOf(const Figure& curve);

}  // namespace twinbench::report
