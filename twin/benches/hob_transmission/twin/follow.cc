#include "twin/benches/hob_transmission/twin/twin.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "mechanics/steady_gear_train.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/hob_transmission/twin/encoders.h"
#include "twin/benches/hob_transmission/twin/path.h"
#include "twin/core/reading.h"
#include "twin/sim/pointwise_follow.h"

namespace twinbench::sim {
namespace {

/// One sample of a record: how the machine ran, and what effects add to what is shown.
struct HobStop {
  double hob_shown_rad = kNaN;  // as recorded, but for what effects add
  double zero_rad = 0.0;        // of the table, where the hob's encoder shows zero
  double hob_speed_rad_s = 0.0;
  double side = 1.0;    // of the play at which the wheel drags the table
  CounterSample added;  // by effects
};

struct HobCourse {
  std::vector<HobStop> stops;        // one a reading
  std::vector<std::string> unfixed;  // what the record does not say and what was taken instead
};

class CourseMaker {
 public:
  /// @param half_play_rad  Of the table.
  CourseMaker(const std::vector<Reading>& record, HobPath& path, double half_play_rad)
      : record_(record), path_(path), procedure_(HobOf(path.actual()).hob_procedure), half_play_rad_(half_play_rad) {}

  HobCourse Make() {
    FindZeros();
    for (std::size_t i = 0; i < record_.size(); ++i) course_.stops.push_back(StopOf(i));
    NoteUnfixed();
    return std::move(course_);
  }

 private:
  double Ratio() const { return HobOf(path_.actual()).transmission.Ratio(); }

  double Table_rad(const Reading& r) const {
    return r.measured_rad + (procedure_.encoder_zero == "table_origin" ? 0.0 : r.head_rad);
  }

  /// Both encoders of this bench count from where the chain began. If they do not, the table's angle is believed.
  void FindZeros() {
    constexpr double kSame_rad = 1e-3;  // errors are smaller
    std::map<int, std::pair<double, int>> sum;
    for (const Reading& r : record_) {
      const double m_rad = Table_rad(r) - Ratio() * r.reference_rad;
      if (!std::isfinite(m_rad)) continue;
      sum[r.setup].first += m_rad;
      ++sum[r.setup].second;
    }
    for (const auto& [setup, of] : sum) {
      const double mean_rad = of.first / of.second;
      if (std::abs(mean_rad) > kSame_rad) zero_rad_[setup] = mean_rad;
    }
  }

  HobStop StopOf(std::size_t i) {
    const Reading& r = record_[i];
    HobStop stop;
    const double velocity_rad_s = Velocity_rad_s(i);
    stop.hob_speed_rad_s = velocity_rad_s / Ratio();
    if (zero_rad_.contains(r.setup)) stop.zero_rad = zero_rad_.at(r.setup);
    if (i > 0) TurnRound(i - 1, i);
    Drive(i);
    stop.side = side_;
    const double table_rad = Table_rad(r);
    if (std::isfinite(table_rad)) path_.Travel(table_rad);
    stop.added = {r.time, 0.0, 0.0, velocity_rad_s, 0.0};
    path_.Disturb({r.time, r.reading, table_rad, velocity_rad_s}, stop.added);
    stop.hob_shown_rad = r.reference_rad - stop.added.hob_encoder_rad;
    return stop;
  }

  /// As recorded, else from the samples before and behind of the same pass.
  double Velocity_rad_s(std::size_t i) const {
    if (std::isfinite(record_[i].velocity_rad_s)) return record_[i].velocity_rad_s;
    const auto same = [&](std::size_t k) { return k < record_.size() && record_[k].pass == record_[i].pass; };
    const Reading& a = record_[i > 0 && same(i - 1) ? i - 1 : i];
    const Reading& b = record_[same(i + 1) ? i + 1 : i];
    const double step_s = ToSeconds(b.time - a.time);
    return step_s > 0.0 ? (b.measured_rad - a.measured_rad) / step_s : 0.0;
  }

  /// Behind a pass the table goes on until the computer has seen its last sample, and out over the ramp; before the
  /// next one it comes in over a ramp. Way and time between the samples tell how far that was.
  void TurnRound(std::size_t last, std::size_t first) {
    const Reading &a = record_[last], &b = record_[first];
    const double v_a = Velocity_rad_s(last), v_b = Velocity_rad_s(first);
    if (a.pass == b.pass || !(v_a * v_b < 0.0)) return;
    const double waited_s = procedure_.rest_s + (a.setup != b.setup ? procedure_.remount_s : 0.0);
    const double moved_s = ToSeconds(b.time - a.time) - waited_s;
    // A log that is read all the way has no ramps beyond it; where no time is known it may have.
    const double ramp_s = moved_s > 0.0 ? std::min(procedure_.ramp_s, 0.5 * moved_s) : procedure_.ramp_s;
    const double steady_s = moved_s - 2.0 * ramp_s;
    const double way_rad = Table_rad(b) - Table_rad(a) - 0.5 * ramp_s * (v_a + v_b);
    const double on_s = std::clamp((way_rad - v_b * steady_s) / (v_a - v_b), 0.0, std::max(0.0, steady_s));
    const double turned_rad = Table_rad(a) + v_a * (on_s + 0.5 * ramp_s);
    if (std::isfinite(turned_rad)) path_.Travel(turned_rad);
  }

  /// Whether it was read all the way from the sample before, at the usual distance in time.
  bool IsContinued(std::size_t i) const {
    constexpr double kUsual = 3.0;
    if (i == 0 || record_[i].setup != record_[i - 1].setup) return false;
    if (record_[i].pass == record_[i - 1].pass) return true;
    const double step_s = ToSeconds(record_[i].time - record_[i - 1].time);
    return i > 1 && step_s > 0.0 && step_s < kUsual * ToSeconds(record_[i - 1].time - record_[i - 2].time);
  }

  /// From the sample before; where a pass begins that was not read all the way to it the wheel drags already.
  void Drive(std::size_t i) {
    const Reading& r = record_[i];
    const double at_rad = Ratio() * r.reference_rad;
    if (!IsContinued(i)) {
      const double velocity_rad_s = Velocity_rad_s(i);
      const double goes = r.direction != 0 ? r.direction : velocity_rad_s;
      if (goes != 0.0) side_ = std::copysign(1.0, goes);
    } else {
      Cross(at_rad - driven_rad_);
    }
    if (std::isfinite(at_rad)) driven_rad_ = at_rad;
  }

  void Cross(double way_rad) {
    if (!std::isfinite(way_rad) || way_rad == 0.0) return;
    side_ = half_play_rad_ > 0.0 ? std::clamp(side_ + way_rad / half_play_rad_, -1.0, 1.0) : std::copysign(1.0, way_rad);
  }

  void NoteUnfixed() {
    course_.unfixed.push_back("where the table turned round between passes: from times and [hob_procedure]");
    if (!zero_rad_.empty()) course_.unfixed.push_back("zero of the hob's encoder: by the mean of a mounting");
  }

  const std::vector<Reading>& record_;
  HobPath& path_;
  const HobProcedureSettings& procedure_;
  double half_play_rad_;
  double side_ = 1.0, driven_rad_ = 0.0;  // of the play, and where the wheel was
  std::map<int, double> zero_rad_;
  HobCourse course_;
};

/// The course of a record. The hob's angle is what each sample is known by: with it the table's follows.
///
/// @param path  Its effects are led along the course, out to where the table turned round behind each pass.
HobCourse FollowCourse(const std::vector<Reading>& record, HobPath& path, double half_play_rad) {
  return CourseMaker(record, path, half_play_rad).Make();
}

using units::arcsec, units::um;

/// What disturbances add to one sample [rad].
struct HobExtra {
  double transmission_rad = 0.0;                          // motion of the table against the hob
  double table_encoder_rad = 0.0, hob_encoder_rad = 0.0;  // shown
  double interferometer_rad = 0.0;
};

using HobPoint = BenchPoint<HobExtra>;

model::Point Angle(const char* name) {
  return {name, "arcsec", arcsec, 1e-2 * arcsec};
}
model::Point Length(const char* name) {
  return {name, "um", um, 0.01 * um};
}

const std::vector<HobPoint>& HobPoints() {
  using E = HobExtra;
  using S = Scenario;
  static const std::vector<HobPoint> points = {
      {Angle("transmission"), [](E& e) -> double& { return e.transmission_rad; }},
      {Angle("table_encoder"), [](E& e) -> double& { return e.table_encoder_rad; }},
      {Angle("hob_encoder"), [](E& e) -> double& { return e.hob_encoder_rad; }},
      {Angle("interferometer"), [](E& e) -> double& { return e.interferometer_rad; }},
      {Angle("worm.backlash"), nullptr, [](S& s) -> double& { return HobOf(s).transmission.backlash_rad; }},
      {{"table.friction", "Nm", 1.0, 1.0},
       nullptr,
       [](S& s) -> double& { return HobOf(s).transmission.friction_Nm; }},
      {Length("table_encoder.eccentricity"), nullptr,
       [](S& s) -> double& { return HobOf(s).table_encoder.eccentricity_m; }},
      {Length("hob_encoder.eccentricity"), nullptr,
       [](S& s) -> double& { return HobOf(s).hob_encoder.eccentricity_m; }}};
  return points;
}

/// The orders that an evaluation takes as unknown are not the scenario's to say.
Scenario WithoutFreeOrders(Scenario scenario) {
  TransmissionSettings& t = HobOf(scenario).transmission;
  WithoutBullet(HobOf(scenario).mechanics);
  std::erase_if(t.harmonics, [&](const HarmonicSettings& h) {
    return h.order == std::round(h.order) && h.order >= 1.0 && h.order <= t.free_orders;
  });
  return scenario;
}

class HobFollow : public PointwiseFollow<HobExtra> {
 public:
  HobFollow(const Scenario& stated, const std::vector<Reading>& its_record)
      : PointwiseFollow(WithoutFreeOrders(Foreseeable(stated, its_record)), its_record, HobPoints()),
        path_(scenario()),
        train_(path_.train()),
        encoders_(path_.actual(), path_.HobSignals()),
        course_(FollowCourse(record(), path_, train_.half_play_rad())) {
    for (const Reading& r : record()) {
      if (std::isfinite(r.head_rad)) rings_.try_emplace(r.head_rad, encoders_.TableRing(r.head_rad));
    }
  }

  std::vector<std::string> Unfixed() const override { return course_.unfixed; }

 protected:
  Eigen::MatrixXd Shown(const std::vector<HobExtra>& extra) const override {
    Eigen::MatrixXd shown_rad(std::ssize(extra), 2);
    for (std::size_t i = 0; i < extra.size(); ++i) shown_rad.row(static_cast<Eigen::Index>(i)) = At(i, extra[i]);
    return shown_rad;
  }

  std::unique_ptr<model::Follow> On(const Scenario& changed) const override {
    return std::make_unique<HobFollow>(changed, record());
  }

 private:
  Eigen::RowVector2d At(std::size_t i, const HobExtra& extra) const {
    const HobStop& stop = course_.stops[i];
    const Reading& r = record()[i];
    const double ratio = HobOf(path_.actual()).transmission.Ratio();
    const double hob_shown_rad = stop.hob_shown_rad - extra.hob_encoder_rad;
    if (!std::isfinite(hob_shown_rad) || !std::isfinite(r.head_rad)) return Eigen::RowVector2d::Constant(kNaN);
    const double hob_rad = encoders_.Hob_rad(hob_shown_rad) + stop.zero_rad / ratio;
    const double velocity_rad_s = ratio * stop.hob_speed_rad_s;
    const double table_rad =
        train_.Table_rad(hob_rad, stop.hob_speed_rad_s, stop.side) + extra.transmission_rad;
    const double scale_rad = rings_.at(r.head_rad).Scale_rad(table_rad);
    const double table_shown_rad =
        encoders_.TableShown_rad(scale_rad, r.head_rad) + stop.added.table_encoder_rad + extra.table_encoder_rad;
    return {table_shown_rad - ratio * r.reference_rad,
            path_.Interferometer_rad(table_rad, hob_rad, velocity_rad_s, r.time) + stop.added.interferometer_rad +
                extra.interferometer_rad};
  }

  HobPath path_;
  mechanics::SteadyGearTrain train_;
  HobEncoders encoders_;
  HobCourse course_;
  std::map<double, mechanics::RingEncoder> rings_;  // of the table, by its head
};

}  // namespace

std::unique_ptr<model::Follow> FollowHob(const Scenario& scenario, const std::vector<Reading>& record) {
  return std::make_unique<HobFollow>(scenario, record);
}

}  // namespace twinbench::sim
