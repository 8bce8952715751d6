#include "twin/benches/rotary_4dof/twin/course.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/table_stack.h"
#include "twin/model/local_level.h"
#include "twin/sim/axes.h"
#include "twin/sim/environment.h"

namespace twinbench::sim {
namespace {

using mechanics::Axis;

/// Whether the tables were mounted anew between two readings.
bool IsRemounted(const Reading& before, const Reading& now) {
  return before.setup != now.setup || before.phase != now.phase;
}

double OrZero(double value) {
  return std::isfinite(value) ? value : 0.0;
}

double Duration_s(const TableSettings& table, double travel_rad) {
  return std::max(table.move_time_s, std::abs(travel_rad) / table.speed_rad_s);
}

/// The room's temperature behind what the thermometer showed; NaN where it showed nothing.
Eigen::VectorXd RoomTemperature_degC(const std::vector<Reading>& record, double noise_K) {
  std::vector<double> time_s, shown_degC;
  for (const Reading& r : record) {
    if (!std::isfinite(r.temperature_degC)) continue;
    time_s.push_back(ToSeconds(r.time));
    shown_degC.push_back(r.temperature_degC);
  }
  const auto n = static_cast<Eigen::Index>(time_s.size());
  const Eigen::VectorXd smooth_degC = model::Smoothed(Eigen::Map<Eigen::VectorXd>(time_s.data(), n),
                                                      Eigen::Map<Eigen::VectorXd>(shown_degC.data(), n), noise_K);
  Eigen::VectorXd room_degC = Eigen::VectorXd::Constant(std::ssize(record), kNaN);
  Eigen::Index next = 0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (std::isfinite(record[i].temperature_degC)) room_degC[static_cast<Eigen::Index>(i)] = smooth_degC[next++];
  }
  return room_degC;
}

/// The drives as they were sent along a record.
class RecordedDrives {
 public:
  explicit RecordedDrives(const Scenario& actual)
      : actual_(actual),
        plant_(mechanics::MakePlant(mechanics::FidelityFromName(RotaryOf(actual).mechanics.fidelity),
                                    StackOf(StackOfBench(actual)))) {}

  void Mount(const mechanics::ChainGeometry& geometry) { plant_->Mount(geometry); }

  /// Both tables move at once, settle, and their in-position windows pass.
  void GoTo(double target_rad, double reference_rad) {
    const RotarySettings& own = RotaryOf(actual_);
    const double target_s = Start(Axis::kTarget, target_rad, own.target);
    const double reference_s = Start(Axis::kReference, reference_rad, own.reference);
    const double longest_s = std::max(target_s, reference_s);
    if (longest_s == 0.0) return;
    const double passed_s = plant_->AdvanceUntilSettled(longest_s + kPatience_s);
    Dwell(std::max(target_s + own.target.settle_s, reference_s + own.reference.settle_s) - passed_s);
  }

  void Dwell(double for_s) { plant_->Advance(std::max(0.0, for_s)); }

  mechanics::StackState State() const { return plant_->State(); }
  int Direction(Axis axis) const { return direction_[static_cast<std::size_t>(axis)]; }
  /// On its last move.
  double Travelled_rad(Axis axis) const { return travelled_rad_[static_cast<std::size_t>(axis)]; }

 private:
  static constexpr double kPatience_s = 10.0;

  /// @return how long the move takes; 0 if there is nowhere to go.
  double Start(Axis axis, double angle_rad, const TableSettings& table) {
    const double to_rad = CommandedAngle_rad(table.compensation, angle_rad);
    const double travel_rad = to_rad - plant_->CommandedEnd_rad(axis);
    if (travel_rad == 0.0) return 0.0;
    const double duration_s = Duration_s(table, travel_rad);
    plant_->StartMove(axis, to_rad, duration_s);
    direction_[static_cast<std::size_t>(axis)] = travel_rad > 0.0 ? 1 : -1;
    travelled_rad_[static_cast<std::size_t>(axis)] = std::abs(travel_rad);
    return duration_s;
  }

  const Scenario& actual_;
  std::unique_ptr<mechanics::Plant> plant_;
  std::array<int, 2> direction_ = {1, 1};
  std::array<double, 2> travelled_rad_ = Moment{}.travelled_rad;
};

class CourseMaker {
 public:
  CourseMaker(const std::vector<Reading>& record, double stated_noise_K, OpticalPath& path)
      : record_(record),
        path_(path),
        drives_(path.actual()),
        room_(path.actual().environment, path.actual().seed),
        step_rad_(2.0 * units::kPi / std::max(1, RotaryOf(path.actual()).procedure.positions)),
        room_degC_(RoomTemperature_degC(record, stated_noise_K)) {}

  RotaryCourse Make() {
    for (std::size_t i = 0; i < record_.size(); ++i) AddStop(i);
    NoteUnfixed();
    return std::move(course_);
  }

 private:
  const Scenario& actual() const { return path_.actual(); }

  void AddStop(std::size_t i) {
    const Reading& r = record_[i];
    const bool remounted = i == 0 || IsRemounted(record_[i - 1], r);
    if (remounted) Mount(r);
    const bool new_pass = remounted || record_[i - 1].pass != r.pass || record_[i - 1].direction != r.direction;
    if (new_pass && r.phase == Phase::kFullCircle) {
      const double behind_rad =
          OrZero(r.target_rad) - r.direction * RotaryOf(actual()).procedure.run_up_steps * step_rad_;
      drives_.GoTo(behind_rad, Shift_rad(r) - behind_rad);
    }
    drives_.GoTo(OrZero(r.target_rad), OrZero(r.reference_rad));
    drives_.Dwell(OrZero(r.dwell_s));
    course_.stops.push_back(StopOf(r, room_degC_[static_cast<Eigen::Index>(i)]));
  }

  static double Shift_rad(const Reading& r) { return OrZero(r.target_rad) + OrZero(r.reference_rad); }

  void Mount(const Reading& r) {
    drives_.GoTo(0.0, Shift_rad(r));
    const bool reseats = RotaryOf(actual()).procedure.clamping == "reseat";
    const Mounting nominal{reseats ? 0.0 : Shift_rad(r), reseats ? -Shift_rad(r) : 0.0, reseats};
    drives_.Mount(path_.stand().Mount(path_.effects().Actual(nominal)));
    course_.stands.push_back(path_.stand());
    mounted_ =
        r.time - FromSeconds(RotaryOf(actual()).procedure.remount_s + WayToFirstStop_s(r) + OrZero(r.dwell_s));
  }

  /// From the mounting position over the run-up to the first stop, with the in-position windows.
  double WayToFirstStop_s(const Reading& r) const {
    if (r.phase != Phase::kFullCircle) return 0.0;
    const double run_up_rad = RotaryOf(actual()).procedure.run_up_steps * step_rad_;
    const double behind_rad = OrZero(r.target_rad) - r.direction * run_up_rad;
    return MoveTime_s(behind_rad) + MoveTime_s(run_up_rad);
  }

  double MoveTime_s(double travel_rad) const {
    if (travel_rad == 0.0) return 0.0;
    const auto of = [&](const TableSettings& t) { return Duration_s(t, travel_rad) + t.settle_s; };
    return std::max(of(RotaryOf(actual()).target), of(RotaryOf(actual()).reference));
  }

  RecordedStop StopOf(const Reading& r, double room_degC) {
    RecordedStop stop;
    stop.axes = drives_.State();
    stop.moment = MomentOf(r, room_degC, stop.axes);
    stop.mounting = static_cast<int>(course_.stands.size()) - 1;
    stop.start = r.time;
    stop.n_samples = SamplesOf(r, RotaryOf(actual()).adc);
    stop.swept = std::isfinite(r.autocollimator_yaw_rad + r.autocollimator_tilt_rad);
    const double gain = 1.0 + RotaryOf(actual()).autocollimator.gain_error;
    stop.seen_yaw_rad = r.autocollimator_yaw_rad / gain;
    stop.seen_tilt_rad = r.autocollimator_tilt_rad / gain;
    path_.effects().Advance(stop.moment);
    stop.pose = path_.effects().Pose(stop.moment);
    stop.light = path_.LightAt(stop.moment);
    path_.effects().AlterSignal(stop.moment, stop.added_V);
    return stop;
  }

  Moment MomentOf(const Reading& r, double room_degC, const mechanics::StackState& axes) {
    const double window_s = std::max(RotaryOf(actual()).target.settle_s, RotaryOf(actual()).reference.settle_s);
    Moment moment;
    const Duration block = BlockTime(RotaryOf(actual()).adc, SamplesOf(r, RotaryOf(actual()).adc));
    moment.now = r.time + block / 2;
    moment.averaged_s = ToSeconds(block);
    moment.mounted = mounted_;
    moment.arrived = r.phase == Phase::kFullCircle ? r.time - FromSeconds(OrZero(r.dwell_s) + window_s) : mounted_;
    moment.temperature_K = AboveReference_K(r, room_degC);
    moment.target_rad = axes.target_rad;
    moment.reference_rad = axes.reference_rad;
    moment.target_direction = drives_.Direction(Axis::kTarget);
    moment.reference_direction = drives_.Direction(Axis::kReference);
    moment.departed.fill(r.time);  // before each reading anew, for all that play knows
    moment.travelled_rad = {drives_.Travelled_rad(Axis::kTarget), drives_.Travelled_rad(Axis::kReference)};
    moment.setup = r.setup;
    moment.reading = r.reading;
    return moment;
  }

  double AboveReference_K(const Reading& r, double room_degC) {
    if (std::isfinite(room_degC)) return room_degC - actual().environment.reference_degC;
    without_temperature_ = true;
    return room_.AboveReference_K(r.time);
  }

  void NoteUnfixed() {
    course_.unfixed.push_back("moments of the mountings: procedure.remount_s before the first reading");
    if (without_temperature_) course_.unfixed.push_back("temperature where none was logged: as [environment] says");
  }

  const std::vector<Reading>& record_;
  OpticalPath& path_;
  RecordedDrives drives_;
  Environment room_;
  double step_rad_;
  Eigen::VectorXd room_degC_;
  Time mounted_{};
  bool without_temperature_ = false;
  RotaryCourse course_;
};

}  // namespace

RotaryCourse FollowCourse(const std::vector<Reading>& record, double thermometer_noise_K, OpticalPath& path) {
  return CourseMaker(record, thermometer_noise_K, path).Make();
}

}  // namespace twinbench::sim
