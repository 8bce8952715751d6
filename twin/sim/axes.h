#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>

#include "mechanics/plant.h"
#include "twin/core/shared_settings.h"
#include "twin/sim/restlessness.h"
#include "twin/sim/schedule.h"

namespace twinbench::sim {

/// Two tables, one upon the other, and how the upper one is mounted.
struct TableStack {
  const MechanicsSettings& mechanics;
  const TableSettings &target, &reference;
  mechanics::ChainGeometry geometry = {};
  std::uint64_t seed = 0;  // of what stirs it by chance
};

mechanics::StackParameters StackOf(const TableStack& stack);

/// The drives of both tables on the clock of the queue: moves take their time, and in-position is reported after
/// it.
class Axes {
 public:
  Axes(const TableStack& stack, EventQueue& queue);

  /// Starts a move; one to where the axis already stands is over at once and counts as none.
  /// @return true if the axis moves.
  bool StartMove(mechanics::Axis axis, double to_rad);

  /// Runs the queue until the move has ended, the in-position window has passed and the servo is quiet, but for no
  /// longer than `within`. @return whether it got there.
  bool Settles(mechanics::Axis axis, Duration within);
  /// Brings the axis to rest from where it is.
  void Stop(mechanics::Axis axis);
  /// Whether Settles would return at once.
  bool InPosition(mechanics::Axis axis);
  bool Moving(mechanics::Axis axis) const { return queue_.Now() < drive(axis).arrival; }
  double Commanded_rad(mechanics::Axis axis) const { return drive(axis).commanded_rad; }

  /// Lets the servos of both axes grow quiet, for at most a second: the one that arrives last can push the other
  /// out of its window again. @return whether they are; false at once while an axis moves.
  bool ComeToRest();
  void Mount(const mechanics::ChainGeometry& geometry);

  /// Angles and deflections at the queue's time.
  mechanics::StackState Look();
  /// The same at a time before, as far as it is known while the servos are quiet: they stood as they stand, the
  /// floor shook as it did.
  mechanics::StackState LookBack(Time time);

  int Direction(mechanics::Axis axis) const { return drive(axis).direction; }
  /// Begin of the axis' last move, and how far its encoder has come since; infinitely far before the first one.
  Time Departure(mechanics::Axis axis) const { return drive(axis).departure; }
  double Travelled_rad(mechanics::Axis axis);
  Time LastArrival() const { return last_arrival_; }

  /// Whether something moves or a servo is not quiet yet.
  bool IsRestless();
  /// Period of the fastest thing in what Look shows: while servos work, as long as a sine whose knots are their
  /// periods (block_course.h); at rest that of the floor's vibration; infinite where nothing stirs.
  double Shortest_s();

 private:
  struct Drive {
    double commanded_rad = 0.0;
    double departed_rad = -std::numeric_limits<double>::infinity();
    Time departure{};
    int direction = 1;
    Time arrival{};
    Time watched_from{}, given_up = Time::min();  // a look for quietness, and when it ended in vain
    double move_time_s, speed_rad_s, settle_s;
  };
  Drive& drive(mechanics::Axis axis) { return drives_[static_cast<std::size_t>(axis)]; }
  const Drive& drive(mechanics::Axis axis) const { return drives_[static_cast<std::size_t>(axis)]; }
  double Encoder_rad(mechanics::Axis axis);
  const mechanics::StackState& PlantState();
  void CatchUp();
  void Serve();

  EventQueue& queue_;
  std::array<Schedule, 2> schedules_;
  Duration servo_period_;
  bool is_driven_;        // by servos, not straight to where they are told
  bool serving_ = false;  // a servo step is scheduled
  std::unique_ptr<mechanics::Plant> plant_;
  std::optional<mechanics::StackState> plant_state_;  // as long as nothing has happened to the plant since
  Restlessness restlessness_;
  std::array<Drive, 2> drives_;
  Time plant_time_{};
  Time last_arrival_{};
};

}  // namespace twinbench::sim
