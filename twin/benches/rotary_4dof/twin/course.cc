#include "twin/benches/rotary_4dof/twin/course.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/model/local_level.h"
#include "twin/sim/environment.h"

namespace twinbench::sim {
namespace {

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

class CourseMaker {
 public:
  CourseMaker(const std::vector<Reading>& record, double stated_noise_K, OpticalPath& path)
      : record_(record),
        path_(path),
        room_(path.actual().environment, path.actual().RunSeed()),
        step_rad_(2.0 * units::kPi / std::max(1, RotaryOf(path.actual()).procedure.positions)),
        room_degC_(RoomTemperature_degC(record, stated_noise_K)) {}

  RotaryCourse Make(DrivesOnce& drives) {
    for (std::size_t i = 0; i < record_.size(); ++i) AddWay(i);
    const DrivesOnce::Stops driven = drives.Along(actual(), steps_);
    for (std::size_t i = 0; i < record_.size(); ++i) {
      AddStop(record_[i], ways_[i], (*driven)[ways_[i].step], room_degC_[static_cast<Eigen::Index>(i)]);
    }
    NoteUnfixed();
    return std::move(course_);
  }

 private:
  /// How a reading was come to.
  struct Way {
    std::size_t step = 0;  // of the drives, the last one
    int mounting = 0;
    Time mounted{};
  };

  const Scenario& actual() const { return path_.actual(); }

  void AddWay(std::size_t i) {
    const Reading& r = record_[i];
    const bool remounted = i == 0 || IsRemounted(record_[i - 1], r);
    if (remounted) Mount(r);
    const bool new_pass = remounted || record_[i - 1].pass != r.pass || record_[i - 1].direction != r.direction;
    if (new_pass && r.phase == Phase::kFullCircle) {
      const double behind_rad = BehindFirstStop_rad(r);
      steps_.push_back({behind_rad, Shift_rad(r) - behind_rad});
    }
    steps_.push_back({OrZero(r.target_rad), OrZero(r.reference_rad), std::max(0.0, OrZero(r.dwell_s))});
    ways_.push_back({steps_.size() - 1, static_cast<int>(course_.stands.size()) - 1, mounted_});
  }

  static double Shift_rad(const Reading& r) { return OrZero(r.target_rad) + OrZero(r.reference_rad); }

  double BehindFirstStop_rad(const Reading& r) const {
    return OrZero(r.target_rad) - r.direction * RotaryOf(actual()).procedure.run_up_steps * step_rad_;
  }

  void Mount(const Reading& r) {
    const bool reseats = RotaryOf(actual()).procedure.clamping == "reseat";
    const Mounting nominal{reseats ? 0.0 : Shift_rad(r), reseats ? -Shift_rad(r) : 0.0, reseats};
    steps_.push_back({0.0, Shift_rad(r), 0.0, path_.stand().Mount(path_.effects().Actual(nominal))});
    course_.stands.push_back(path_.stand());
    mounted_ =
        r.time - FromSeconds(RotaryOf(actual()).procedure.remount_s + WayToFirstStop_s(r) + OrZero(r.dwell_s));
  }

  /// From the mounting position over the run-up to the first stop, with the in-position windows.
  double WayToFirstStop_s(const Reading& r) const {
    if (r.phase != Phase::kFullCircle) return 0.0;
    return MoveTime_s(BehindFirstStop_rad(r)) + MoveTime_s(RotaryOf(actual()).procedure.run_up_steps * step_rad_);
  }

  double MoveTime_s(double travel_rad) const {
    if (travel_rad == 0.0) return 0.0;
    const auto of = [&](const TableSettings& t) { return Duration_s(t, travel_rad) + t.settle_s; };
    return std::max(of(RotaryOf(actual()).target), of(RotaryOf(actual()).reference));
  }

  void AddStop(const Reading& r, const Way& way, const DrivenStop& driven, double room_degC) {
    RecordedStop& stop = course_.stops.emplace_back();
    stop.axes = driven.axes;
    stop.moment = MomentOf(r, room_degC, driven, way.mounted);
    stop.mounting = way.mounting;
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
  }

  Moment MomentOf(const Reading& r, double room_degC, const DrivenStop& driven, Time mounted) {
    const double window_s = std::max(RotaryOf(actual()).target.settle_s, RotaryOf(actual()).reference.settle_s);
    Moment moment;
    const Duration block = BlockTime(RotaryOf(actual()).adc, SamplesOf(r, RotaryOf(actual()).adc));
    moment.lag_s = path_.electronics().Lag_s();
    moment.now = r.time + block / 2 - FromSeconds(moment.lag_s);
    moment.averaged_s = ToSeconds(block);
    moment.mounted = mounted;
    moment.arrived = r.phase == Phase::kFullCircle ? r.time - FromSeconds(OrZero(r.dwell_s) + window_s) : mounted;
    moment.temperature_K = AboveReference_K(r, room_degC);
    moment.target_rad = driven.axes.target_rad;
    moment.reference_rad = driven.axes.reference_rad;
    moment.target_direction = driven.direction[0];
    moment.reference_direction = driven.direction[1];
    moment.departed.fill(r.time);  // before each reading anew, for all that play knows
    moment.travelled_rad = driven.travelled_rad;
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
  Environment room_;
  double step_rad_;
  Eigen::VectorXd room_degC_;
  Time mounted_{};
  std::vector<DriveStep> steps_;
  std::vector<Way> ways_;  // one a reading
  bool without_temperature_ = false;
  RotaryCourse course_;
};

}  // namespace

RotaryCourse FollowCourse(const std::vector<Reading>& record, double thermometer_noise_K, OpticalPath& path,
                          DrivesOnce& drives) {
  return CourseMaker(record, thermometer_noise_K, path).Make(drives);
}

}  // namespace twinbench::sim
