#pragma once

#include <array>

#include "twin/core/reading_column.h"

/// What a reading of the bench freeform_five_axis holds, SI, beside what every reading has.
namespace twinbench::benches::freeform {

/// Commanded: X, Y, Z [m], A, B [rad].
inline const std::array<Quantity, 5> kCommanded = {{{"x_mm"}, {"y_mm"}, {"z_mm"}, {"a_deg"}, {"b_deg"}}};
inline const Quantity kCommandedC{"c_deg"};  // [rad]; of displacements only: the probe's machine has none
inline const std::array<Quantity, 3> kShift_m = {{{"dx_um"}, {"dy_um"}, {"dz_um"}}};
inline const Quantity kCellI{"cell_i"}, kCellJ{"cell_j"};
inline const Quantity kQpdX_V{"qpd_x_V"}, kQpdY_V{"qpd_y_V"}, kQpdSum_V{"qpd_sum_V"}, kCcd_px{"ccd_px"};

}  // namespace twinbench::benches::freeform
