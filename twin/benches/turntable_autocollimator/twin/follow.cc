#include "twin/benches/turntable_autocollimator/twin/twin.h"

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/benches/turntable_autocollimator/twin/course.h"
#include "twin/benches/turntable_autocollimator/twin/mirror_path.h"
#include "twin/sim/pointwise_follow.h"

namespace twinbench::sim {
namespace {

using units::arcsec, units::mrad, units::nm, units::um;
using TurntablePoint = BenchPoint<TurntableExtra>;

// Small against the period of a camera's pixels.
constexpr double kAngleStep_rad = 1e-3 * arcsec, kLengthStep_m = 0.1 * um;

model::Point MirrorAngle(const char* name) {
  return {name, "arcsec", arcsec, kAngleStep_rad};
}
model::Point MirrorLength(const char* name) {
  return {name, "um", um, kLengthStep_m};
}

std::vector<TurntablePoint> OfTables() {
  using E = TurntableExtra;
  return {{MirrorAngle("turntable.ex"), [](E& e) -> double& { return e.mirror.turntable.ex_rad; }},
          {MirrorAngle("turntable.ey"), [](E& e) -> double& { return e.mirror.turntable.ey_rad; }},
          {MirrorAngle("turntable.ez"), [](E& e) -> double& { return e.mirror.turntable.ez_rad; }},
          {MirrorLength("turntable.dx"), [](E& e) -> double& { return e.mirror.turntable.dx_m; }},
          {MirrorLength("turntable.dy"), [](E& e) -> double& { return e.mirror.turntable.dy_m; }},
          {MirrorLength("turntable.dz"), [](E& e) -> double& { return e.mirror.turntable.dz_m; }},
          {MirrorAngle("multitooth.ex"), [](E& e) -> double& { return e.mirror.multitooth.ex_rad; }},
          {MirrorAngle("multitooth.ey"), [](E& e) -> double& { return e.mirror.multitooth.ey_rad; }},
          {MirrorAngle("multitooth.ez"), [](E& e) -> double& { return e.mirror.multitooth.ez_rad; }},
          {MirrorLength("multitooth.dx"), [](E& e) -> double& { return e.mirror.multitooth.dx_m; }},
          {MirrorLength("multitooth.dy"), [](E& e) -> double& { return e.mirror.multitooth.dy_m; }},
          {MirrorLength("multitooth.dz"), [](E& e) -> double& { return e.mirror.multitooth.dz_m; }},
          {MirrorAngle("turntable.yaw"), [](E& e) -> double& { return e.yaw_rad; }}};
}

std::vector<TurntablePoint> OfMountings() {
  using E = TurntableExtra;
  return {{MirrorAngle("axis.ex"), [](E& e) -> double& { return e.mirror.axis.ex_rad; }},
          {MirrorAngle("axis.ey"), [](E& e) -> double& { return e.mirror.axis.ey_rad; }},
          {MirrorLength("axis.dx"), [](E& e) -> double& { return e.mirror.axis.dx_m; }},
          {MirrorLength("axis.dy"), [](E& e) -> double& { return e.mirror.axis.dy_m; }},
          {MirrorAngle("mount.yaw"), [](E& e) -> double& { return e.mirror.mount.ez_rad; }},
          {MirrorAngle("mount.pitch"), [](E& e) -> double& { return e.mirror.mount.ex_rad; }},
          {MirrorAngle("autocollimator.x"), [](E& e) -> double& { return e.shown_rad.x(); }},
          {MirrorAngle("autocollimator.y"), [](E& e) -> double& { return e.shown_rad.y(); }},
          {{"room.temperature", "K", 1.0, 0.01}, [](E& e) -> double& { return e.warmer_K; }}};
}

std::vector<TurntablePoint> OfInstrument() {
  using S = Scenario;
  return {{{"autocollimator.roll", "mrad", mrad, 1e-4},
           nullptr,
           [](S& s) -> double& { return TurntableOf(s).collimator.roll_rad; }},
          {{"autocollimator.gain", "1", 1.0, 1e-5},
           nullptr,
           [](S& s) -> double& { return TurntableOf(s).autocollimator.gain_error; }},
          {{"autocollimator.at_edge", "arcsec", arcsec, 1e-2 * arcsec},
           nullptr,
           [](S& s) -> double& { return TurntableOf(s).collimator.error_at_edge_rad; }},
          {{"mirror.flatness", "nm", nm, 10.0 * nm}, nullptr, [](S& s) -> double& {
             return TurntableOf(s).mirror.flatness_m;
           }}};
}

const std::vector<TurntablePoint>& TurntablePoints() {
  static const std::vector<TurntablePoint> points = [] {
    std::vector<TurntablePoint> all = OfTables();
    for (const auto& part : {OfMountings(), OfInstrument()}) all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return points;
}

Scenario WithFreeTables(Scenario scenario) {
  TurntableSettings& own = TurntableOf(scenario);
  own.multitooth.tooth_rms_rad = 0.0;
  own.polygon.face_rms_rad = own.polygon.pyramid_rms_rad = 0.0;
  own.polygon.face_errors_rad = {0.0};
  LeaveFree(own.turntable);
  LeaveFree(own.multitooth_table);
  WithoutBullet(own.mechanics);
  return scenario;
}

class TurntableFollow : public PointwiseFollow<TurntableExtra> {
 public:
  TurntableFollow(const Scenario& stated, const std::vector<Reading>& its_record,
                  const std::shared_ptr<ImagesOnce>& images)
      : PointwiseFollow(WithFreeTables(Foreseeable(stated, its_record)), its_record, TurntablePoints()),
        images_(images),
        path_(std::make_unique<MirrorPath>(scenario(), kFieldShare, optics::Fidelity::kClosed, images)),
        course_(FollowCourse(record(), path_->actual())) {}

  std::vector<std::string> Unfixed() const override { return course_.unfixed; }

 protected:
  Eigen::MatrixXd Shown(const std::vector<TurntableExtra>& extra) const override {
    Eigen::MatrixXd shown_rad(std::ssize(extra), 2);
    for (std::size_t i = 0; i < extra.size(); ++i) shown_rad.row(static_cast<Eigen::Index>(i)) = At(i, extra[i]);
    return shown_rad;
  }

  std::unique_ptr<model::Follow> On(const Scenario& changed) const override {
    return std::make_unique<TurntableFollow>(changed, record(), images_);
  }

 private:
  static constexpr double kFieldShare = 1.1;

  Eigen::RowVector2d At(std::size_t i, TurntableExtra extra) const {
    const TurntableStop& stop = course_.stops[i];
    if (!stop.known) return Eigen::RowVector2d::Constant(kNaN);
    if (i == 0 || course_.stops[i - 1].mounting != stop.mounting) {
      const TurntableMounting& m = course_.mountings[stop.mounting];
      path_->stand().Mount(m.tilt_rad, m.azimuth_rad, m.eccentricity_m, m.shift_rad);
    }
    path_->stand().Seat(stop.tooth);
    extra.mirror.multitooth.ez_rad += stop.beside_tooth_rad;
    const AutocollimatorReading shown =
        path_->Look(stop.moment, stop.axes, stop.above_K, Eigen::Vector2d::Zero(), extra);
    return {shown.yaw_rad, shown.tilt_rad};
  }

  std::shared_ptr<ImagesOnce> images_;
  std::unique_ptr<MirrorPath> path_;  // its mirror moves from reading to reading
  TurntableCourse course_;
};

}  // namespace

std::unique_ptr<model::Follow> FollowTurntable(const Scenario& scenario, const std::vector<Reading>& record,
                                               const std::shared_ptr<ImagesOnce>& images) {
  return std::make_unique<TurntableFollow>(scenario, record, images);
}

}  // namespace twinbench::sim
