#include "twin/benches/encoder_comparison/estimators/angle_means.h"

#include <cmath>

#include "twin/core/units.h"

namespace twinbench::separate::encoder {
namespace {

struct Part {
  double angle_rad = 0.0, value_rad = 0.0, square_rad2 = 0.0;  // sums
  int count = 0;

  void Add(double angle, double value) {
    angle_rad += angle;
    value_rad += value;
    square_rad2 += value * value;
    ++count;
  }
  double U_rad(const AngleMeans& means) const {
    if (count < 2) return kNaN;
    const double mean = value_rad / count;
    return std::sqrt(std::max(0.0, square_rad2 / count - mean * mean) / (count - 1.0) + means.rounded_rad2 * std::min(1.0, means.visits / count));
  }
};

/// Everything of one group: its curve and what it left over.
void Add(const FittedGroup& group, const harmonics::HarmonicSeries& curve, std::vector<Part>& parts) {
  const auto size = static_cast<double>(parts.size());
  for (std::size_t p = 0; p < group.th_rad.size(); ++p) {
    for (Eigen::Index i = 0; i < group.th_rad[p].size(); ++i) {
      const double turns = group.th_rad[p][i] / units::turn, share = turns - std::floor(turns);
      const auto part = std::min(parts.size() - 1, static_cast<std::size_t>(share * size));
      parts[part].Add(share * units::turn, ValueAt(curve, share * units::turn) + group.fit.rest_rad[p][i]);
    }
  }
}

}  // namespace

AngleMeans MeansOf(const ComparisonFit& fitted, int direction, int parts) {
  std::vector<Part> sums(static_cast<std::size_t>(parts));
  for (const FittedGroup& group : fitted.groups) {
    const int of = group.group->direction;
    if (direction == 0 || of == direction)
      Add(group, of > 0 ? fitted.curves.forward : fitted.curves.backward, sums);
  }
  AngleMeans means;
  means.rounded_rad2 = fitted.rounding.place_rad2;
  means.visits = fitted.rounding.visits * (direction == 0 ? 2.0 : 1.0);
  for (const Part& part : sums) {
    if (part.count == 0) continue;
    means.position_rad.push_back(part.angle_rad / part.count);
    means.value_rad.push_back(part.value_rad / part.count);
    means.u_rad.push_back(part.U_rad(means));
    means.count.push_back(part.count);
  }
  return means;
}

}  // namespace twinbench::separate::encoder
