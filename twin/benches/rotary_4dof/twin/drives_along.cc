#include "twin/benches/rotary_4dof/twin/drives_along.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effect.h"
#include "twin/benches/rotary_4dof/twin/table_stack.h"

namespace twinbench::sim {
namespace {

using mechanics::Axis;

TableDrive DriveOf(const TableSettings& table) {
  return {table.backlash_rad, table.speed_rad_s, table.move_time_s, table.settle_s, table.compensation};
}

/// The drives as they were sent along a record.
class RecordedDrives {
 public:
  explicit RecordedDrives(const Scenario& actual)
      : drives_{DriveOf(RotaryOf(actual).target), DriveOf(RotaryOf(actual).reference)},
        plant_(mechanics::MakePlant(mechanics::FidelityFromName(RotaryOf(actual).mechanics.fidelity),
                                    StackOf(RotaryTableStack(actual)))) {}

  DrivenStop Take(const DriveStep& step) {
    GoTo(step.target_rad, step.reference_rad);
    plant_->Advance(step.dwell_s);
    if (step.mounted) plant_->Mount(*step.mounted);
    stop_.axes = plant_->State();
    return stop_;
  }

 private:
  static constexpr double kPatience_s = 10.0;

  /// Both tables move at once, settle, and their in-position windows pass.
  void GoTo(double target_rad, double reference_rad) {
    const double target_s = Start(Axis::kTarget, target_rad);
    const double reference_s = Start(Axis::kReference, reference_rad);
    const double longest_s = std::max(target_s, reference_s);
    if (longest_s == 0.0) return;
    const double passed_s = plant_->AdvanceUntilSettled(longest_s + kPatience_s);
    const double over_s = std::max(target_s + drives_[0].settle_s, reference_s + drives_[1].settle_s);
    plant_->Advance(std::max(0.0, over_s - passed_s));
  }

  /// @return how long the move takes; 0 if there is nowhere to go.
  double Start(Axis axis, double angle_rad) {
    const auto k = static_cast<std::size_t>(axis);
    const double to_rad = CommandedAngle_rad(drives_[k].compensation, angle_rad);
    const double travel_rad = to_rad - plant_->CommandedEnd_rad(axis);
    if (travel_rad == 0.0) return 0.0;
    const double duration_s = std::max(drives_[k].move_time_s, std::abs(travel_rad) / drives_[k].speed_rad_s);
    plant_->StartMove(axis, to_rad, duration_s);
    stop_.direction[k] = travel_rad > 0.0 ? 1 : -1;
    stop_.travelled_rad[k] = std::abs(travel_rad);
    return duration_s;
  }

  std::array<TableDrive, 2> drives_;
  std::unique_ptr<mechanics::Plant> plant_;
  DrivenStop stop_{{}, {1, 1}, Moment{}.travelled_rad};
};

}  // namespace

std::vector<DrivenStop> DriveAlong(const Scenario& actual, const std::vector<DriveStep>& steps) {
  RecordedDrives drives(actual);
  std::vector<DrivenStop> stops;
  stops.reserve(steps.size());
  for (const DriveStep& step : steps) stops.push_back(drives.Take(step));
  return stops;
}

DrivesOnce::Stops DrivesOnce::Along(const Scenario& actual, const std::vector<DriveStep>& steps) {
  constexpr std::size_t kMostKept = 4;  // as believed, with a cause of the drives, and about either
  const RotarySettings& own = RotaryOf(actual);
  Driven asked{own.mechanics, {DriveOf(own.target), DriveOf(own.reference)}, steps};
  const std::scoped_lock lock(mutex_);
  const auto known = std::ranges::find_if(last_, [&](const Driven& driven) {
    return driven.mechanics == asked.mechanics && driven.tables == asked.tables && driven.steps == asked.steps;
  });
  if (known != last_.end()) {
    std::rotate(known, known + 1, last_.end());
    return last_.back().stops;
  }
  asked.stops = std::make_shared<const std::vector<DrivenStop>>(DriveAlong(actual, steps));
  if (last_.size() == kMostKept) last_.erase(last_.begin());
  last_.push_back(std::move(asked));
  return last_.back().stops;
}

}  // namespace twinbench::sim
