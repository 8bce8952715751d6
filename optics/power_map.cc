#include "optics/power_map.h"

#include <algorithm>
#include <cmath>

namespace twinbench::optics {
namespace {

struct Interval {
  double low, high;

  double length() const { return high - low; }
  double middle() const { return 0.5 * (low + high); }
};

/// Share and middle of what of centre +- half lies in `within`. A point (half 0) is in it or not.
Interval Common(double centre, double half, const Interval& within) {
  return {std::max(centre - half, within.low), std::min(centre + half, within.high)};
}

double Share(const Interval& common, double half) {
  if (half > 0.0) return std::max(0.0, common.length()) / (2.0 * half);
  return common.length() >= 0.0 ? 1.0 : 0.0;
}

}  // namespace

double PowerMap::power_W() const {
  double sum = 0.0;
  for (const PowerPatch& patch : patches) sum += patch.power_W;
  return sum;
}

PowerPatch CutToArea(const PowerPatch& patch, const Eigen::Vector2d& half_m, double width_m, double height_m) {
  const Eigen::Vector2d area(0.5 * width_m, 0.5 * height_m);
  // Most rectangles are whole: their centres keep every bit.
  if (std::abs(patch.u_m) + half_m.x() <= area.x() && std::abs(patch.v_m) + half_m.y() <= area.y()) return patch;
  const Interval u = Common(patch.u_m, half_m.x(), {-area.x(), area.x()});
  const Interval v = Common(patch.v_m, half_m.y(), {-area.y(), area.y()});
  return {u.middle(), v.middle(), patch.power_W * Share(u, half_m.x()) * Share(v, half_m.y())};
}

void Paint(const PowerMap& map, IrradianceMap& picture) {
  const double pitch = picture.pitch_m;
  const auto pixel = [&](double from_edge, int count) {
    return std::clamp(static_cast<int>(std::floor(from_edge / pitch)), 0, count - 1);
  };
  picture.power_W += map.power_W();
  const double left = -0.5 * picture.width * pitch, top = 0.5 * picture.height * pitch;
  for (const PowerPatch& patch : map.patches) {
    const int column_end = pixel(patch.u_m + map.half_m.x() - left, picture.width);
    const int row_end = pixel(top - patch.v_m + map.half_m.y(), picture.height);
    for (int row = pixel(top - patch.v_m - map.half_m.y(), picture.height); row <= row_end; ++row) {
      const double v = picture.V(row);
      const double along_v =
          Share(Common(patch.v_m, map.half_m.y(), {v - 0.5 * pitch, v + 0.5 * pitch}), map.half_m.y());
      for (int i = pixel(patch.u_m - map.half_m.x() - left, picture.width); i <= column_end; ++i) {
        const double u = picture.U(i);
        const double along_u =
            Share(Common(patch.u_m, map.half_m.x(), {u - 0.5 * pitch, u + 0.5 * pitch}), map.half_m.x());
        picture.irradiance_W_m2[static_cast<std::size_t>(row * picture.width + i)] +=
            static_cast<float>(patch.power_W * along_u * along_v / (pitch * pitch));
      }
    }
  }
}

}  // namespace twinbench::optics
