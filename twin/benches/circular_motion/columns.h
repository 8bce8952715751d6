#pragma once

#include "twin/core/reading_column.h"

/// Where a reading of the bench circular_motion keeps what has no field of its own.
namespace twinbench::benches::circular {

inline const Quantity kCommandedX_m{"commanded_x_mm"}, kCommandedY_m{"commanded_y_mm"};
inline const Quantity kFeed_m_s{"feed_mm_min"};  // 0: at rest
inline const Quantity kBar_m{"bar_um"}, kEncoder_rad{"encoder_deg"};
inline const Quantity kGridX_m{"grid_x_mm"}, kGridY_m{"grid_y_mm"};

/// Circles of a file that stand in machine coordinates, a pass each, about the centre of what was commanded.
void AboutItsCentre(std::vector<Reading>& readings);

/// The readings with what follows from their columns: target_rad, the commanded polar angle, unwrapped along each
/// pass, and velocity_rad_s, its rate.
std::vector<Reading> WithAngles(std::vector<Reading> readings);
/// The same of one reading behind another, whose angle is known; nullptr: of the first.
Reading WithAngle(const Reading* before, Reading reading);

/// Radial and tangential deviation from the commanded point as the instrument shows it [m]: of the bar its length,
/// of its encoder the angle times the radius. NaN where the instrument showed nothing.
/// @param reading  With its angle.
struct Deviation {
  double radial_m = kNaN, tangential_m = kNaN;
};
Deviation DeviationOf(const Reading& reading);

/// Of the commanded point.
double Radius_m(const Reading& reading);

/// True if the bar measured, false if the grid did.
bool IsOfBar(const Reading& reading);

/// False of a bar without an encoder: the radius is all it shows.
bool ShowsAngle(const Reading& reading);

}  // namespace twinbench::benches::circular
