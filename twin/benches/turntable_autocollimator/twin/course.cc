#include "twin/benches/turntable_autocollimator/twin/course.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/benches/turntable_autocollimator/twin/table_stack.h"
#include "twin/sim/axes.h"
#include "twin/sim/environment.h"

namespace twinbench::sim {
namespace {

using mechanics::Axis;

/// A way that does not go on from the reading before: whoever took the record may number passes anew in each phase.
bool IsNewPass(const Reading& before, const Reading& now) {
  return before.pass != now.pass || before.phase != now.phase || before.direction != now.direction;
}

/// Sends the drives the recorded way on a clock of its own, which gives what lies between mounting, arrival and
/// reading; when a reading was made, the record says.
class CourseMaker {
 public:
  CourseMaker(const std::vector<Reading>& record, const Scenario& actual)
      : record_(record),
        actual_(actual),
        room_(actual_.environment, actual_.RunSeed()),
        axes_(TurntableStack(actual_), queue_),
        pitch_rad_(TurntableOf(actual_).Pitch_rad()) {}

  TurntableCourse Make() {
    for (std::size_t i = 0; i < record_.size(); ++i) course_.stops.push_back(StopOf(i));
    NoteUnfixed();
    return std::move(course_);
  }

 private:
  bool HasPolygon() const { return TurntableOf(actual_).HasPolygon(); }
  const TurntableProcedureSettings& procedure() const { return TurntableOf(actual_).turntable_procedure; }

  TurntableStop StopOf(std::size_t i) {
    const Reading& r = record_[i];
    TurntableStop stop;
    stop.known = std::isfinite(r.target_rad) && std::isfinite(r.reference_rad);
    const bool remounted = i == 0 || record_[i - 1].setup != r.setup;
    if (remounted) Mount(r);
    if (stop.known) GoTo(r, remounted || IsNewPass(record_[i - 1], r));
    const double dwell_s = std::isfinite(r.dwell_s) ? r.dwell_s : 0.0;
    queue_.RunUntil(queue_.Now() + FromSeconds(dwell_s) + TurntableOf(actual_).collimator.HalfReading());
    if (remounted) mounted_ = r.time - (queue_.Now() - mounted_here_);
    stop.moment = {r.time,  mounted_,  r.time - (queue_.Now() - axes_.LastArrival()),
                   r.setup, r.reading, axes_.Direction(Axis::kTarget)};
    stop.axes = axes_.Look();
    stop.above_K = AboveReference_K(r);
    stop.mounting = course_.mountings.size() - 1;
    if (stop.known) {
      stop.tooth = static_cast<int>(std::lround(r.reference_rad / pitch_rad_));
      stop.beside_tooth_rad = r.reference_rad - stop.tooth * pitch_rad_;
    }
    return stop;
  }

  void Send(double angle_rad) {
    axes_.StartMove(Axis::kTarget, CommandedAngle_rad(TurntableOf(actual_).turntable.compensation, angle_rad));
  }

  void Turn(double angle_rad) {
    constexpr Duration kPatience = std::chrono::seconds(100);
    Send(angle_rad);
    axes_.Settles(Axis::kTarget, kPatience);
  }

  void GoTo(const Reading& r, bool new_pass) {
    if (new_pass) Turn(BeforePass_rad(r));
    Send(r.target_rad);
    if (!HasPolygon()) queue_.RunUntil(queue_.Now() + FromSeconds(TurntableOf(actual_).multitooth.index_time_s));
    Turn(r.target_rad);
  }

  double BeforePass_rad(const Reading& r) const {
    if (r.phase == Phase::kCalibration) return -2.0 * procedure().sweep_rad;
    return r.target_rad - r.direction * procedure().run_up_steps * 2.0 * units::kPi / procedure().positions;
  }

  void Mount(const Reading& r) {
    Turn(0.0);
    const TurntableProcedureSettings& p = procedure();
    const int setup = std::clamp(r.setup, 0, p.SetUps() - 1);
    // In a sweep the turntable is off its teeth.
    const double turntable_rad = r.phase == Phase::kCalibration ? 0.0 : r.target_rad;
    const double shift_rad = std::isfinite(turntable_rad + r.reference_rad) ? turntable_rad + r.reference_rad : 0.0;
    const double mounted_rad = HasPolygon() ? TurntableOf(actual_).FaceAngle_rad(setup, 0)
                                            : static_cast<double>(std::lround(shift_rad / pitch_rad_)) * pitch_rad_;
    course_.mountings.push_back(
        {p.Of(p.tilts_rad, setup), p.Of(p.tilt_azimuths_rad, setup), p.Of(p.eccentricities_m, setup), mounted_rad});
    mounted_here_ = queue_.Now();
  }

  double AboveReference_K(const Reading& r) {
    if (std::isfinite(r.temperature_degC)) return r.temperature_degC - actual_.environment.reference_degC;
    without_temperature_ = true;
    return room_.AboveReference_K(r.time);
  }

  void NoteUnfixed() {
    course_.unfixed.push_back(
        "moments of the mountings: as long before a mounting's first reading as [turntable_procedure] needs");
    course_.unfixed.push_back("tilts, azimuths and eccentricities of the mountings: as [turntable_procedure] says");
    if (without_temperature_) course_.unfixed.push_back("temperature where none was logged: as [environment] says");
  }

  const std::vector<Reading>& record_;
  Scenario actual_;
  Environment room_;
  EventQueue queue_;
  Axes axes_;
  double pitch_rad_;
  Time mounted_{}, mounted_here_{};
  bool without_temperature_ = false;
  TurntableCourse course_;
};

}  // namespace

TurntableCourse FollowCourse(const std::vector<Reading>& record, const Scenario& actual) {
  return CourseMaker(record, actual).Make();
}

}  // namespace twinbench::sim
