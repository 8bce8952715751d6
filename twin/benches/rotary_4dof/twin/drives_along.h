#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "mechanics/plant.h"
#include "twin/core/compensation_table.h"
#include "twin/core/scenario.h"

/// The drives of both tables, sent along the course of a record.
namespace twinbench::sim {

/// What a table's drive depends on besides its mechanics.
struct TableDrive {
  double backlash_rad = 0.0, speed_rad_s = 0.0, move_time_s = 0.0, settle_s = 0.0;
  std::optional<CompensationTable> compensation;
  bool operator==(const TableDrive&) const = default;
};

/// What the drives are told, in order.
struct DriveStep {
  double target_rad = 0.0, reference_rad = 0.0;          // where both tables go at once; then they settle
  double dwell_s = 0.0;                                  // behind that
  std::optional<mechanics::ChainGeometry> mounted = {};  // anew, at the end
  bool operator==(const DriveStep&) const = default;
};

/// How the tables stand at the end of a step.
struct DrivenStop {
  mechanics::StackState axes;
  std::array<int, 2> direction = {1, 1};     // of each axis' last move
  std::array<double, 2> travelled_rad = {};  // on it; infinite before the first
};

/// One entry a step.
std::vector<DrivenStop> DriveAlong(const Scenario& actual, const std::vector<DriveStep>& steps);

/// Keeps what was driven last: a diagnosis asks for the same few courses again and again with other light, and dynamics
/// that are stepped through cost a hundred times what the light does.
class DrivesOnce {
 public:
  using Stops = std::shared_ptr<const std::vector<DrivenStop>>;
  Stops Along(const Scenario& actual, const std::vector<DriveStep>& steps);

 private:
  struct Driven {
    MechanicsSettings mechanics;
    std::array<TableDrive, 2> tables;
    std::vector<DriveStep> steps;
    Stops stops = {};
  };
  std::mutex mutex_;
  std::vector<Driven> last_;
};

}  // namespace twinbench::sim
