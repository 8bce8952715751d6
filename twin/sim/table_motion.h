#pragma once

#include <optional>

#include "mechanics/error_motion.h"
#include "twin/core/scenario.h"
#include "twin/core/stream.h"
#include "twin/sim/truth.h"

namespace twinbench::sim {

/// The error motion of one table: what repeats with its angle, and what is drawn anew at every stop. What is drawn
/// anew at every mounting is handed out, for it depends on the mounting where it acts.
class TableMotion {
 public:
  /// @param name  "target" or "reference": begins the names of its random streams.
  /// @param of      Whose seed draws what repeats, and whose run draws the rest.
  TableMotion(const TableSettings& settings, const Scenario& of, const std::string& name);

  mechanics::PoseError DrawSeating() { return Draw(settings_.seating_sd, seating_stream_); }
  void BeginStop() {
    if (scatters_) stop_ = Draw(settings_.repeatability_sd, stop_stream_);
  }

  /// The error at an unwrapped angle of this table's scale, in the frame the settings are given in.
  mechanics::PoseError At(double label_rad) const;

  /// The part that repeats with the angle, at `positions` equal steps from 0.
  TableErrors Repeatable(int positions) const;
  /// The same at any angles.
  TableErrors Repeatable(const std::vector<double>& position_rad) const;

 private:
  static mechanics::PoseError Draw(const std::array<double, kComponents>& sd, Stream& stream);

  TableSettings settings_;
  mechanics::ErrorMotion repeatable_;
  std::optional<mechanics::ErrorMotion> half_frequency_;
  Stream seating_stream_, stop_stream_;
  bool scatters_;
  mechanics::PoseError stop_;
};

}  // namespace twinbench::sim
