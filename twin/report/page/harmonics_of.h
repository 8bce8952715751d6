#pragma once

#include <optional>

#include "twin/report/page/figure.h"

namespace twinbench::report {

/// What a curve at equal steps of a full circle is made of: a picture of the numbers that it shows, no estimate of its own.
///
/// @param curve  A figure of form kAngle.
/// @return amplitudes of orders 1 .. (n - 1)/2 of every series that goes round at n >= 8 equal steps without a gap; nothing if none
///         does.
std::optional<Figure> HarmonicsOf(const Figure& curve);

}  // namespace twinbench::report
