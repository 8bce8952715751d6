#pragma once

#include <optional>
#include <vector>

#include "twin/core/machine.h"

namespace twinbench::sim {

/// A share of the way at a time; between two of them it goes steadily.
struct PathKnot {
  Time time{};
  double share = 0.0;
};

/// From one place to another, along a line or an arc.
class DrivenPath {
 public:
  DrivenPath() = default;
  static DrivenPath Resting(std::vector<double> at, Time now);
  static DrivenPath Line(std::vector<double> from, std::vector<double> to, Time begin, Duration takes);
  /// @param knots  Its times; not empty.
  static DrivenPath Circular(std::vector<double> from, const Arc& arc, std::vector<PathKnot> knots);

  Time End() const { return knots_.back().time; }
  const std::vector<double>& to() const { return to_; }
  std::vector<double> At(Time now) const { return AtShare(Share(now)); }
  std::vector<double> AtShare(double share) const;

 private:
  double Share(Time now) const;
  std::vector<double> OnArc(double share) const;

  std::vector<double> from_, to_;
  std::optional<Arc> arc_;
  std::vector<PathKnot> knots_;
};

}  // namespace twinbench::sim
