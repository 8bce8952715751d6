#include "tests/foreign/stand_fault.h"

namespace twinbench::foreign {
namespace {

constexpr double kArcsec = M_PI / 648000.0, kUm = 1e-6;

/// Readings in the order and at the times of a bench that is in no hurry.
class Clock {
 public:
  explicit Clock(Dice& dice)
      : dice_(dice),
        slow_K_(dice.Between(0.2, 0.6)),
        slow_s_(dice.Sized(2500.0, 8000.0)),
        phase_(dice.Phase()),
        trend_K_s_(dice.Between(-5e-5, 5e-5)) {}
  void Wait(double seconds) { t_s_ += seconds; }
  void Take(StandStop stop, StandRun& run) {
    stop.dwell_s = dice_.Sized(0.7, 5.0);
    t_s_ += dice_.Between(2.2, 3.4) + stop.dwell_s;
    stop.t_s = t_s_;
    stop.temperature_degC = 20.0 + trend_K_s_ * t_s_ + slow_K_ * std::sin(2.0 * M_PI * t_s_ / slow_s_ + phase_);
    run.push_back(stop);
  }

 private:
  Dice& dice_;
  double slow_K_, slow_s_, phase_, trend_K_s_, t_s_ = 0.0;
};

/// Yaw and then tilt, there and back, about the nominal spot.
void Calibrate(Clock& clock, StandRun& run) {
  constexpr int kSteps = 13;
  for (const bool is_yaw : {true, false}) {
    for (const int direction : {1, -1}) {
      for (int k = 0; k < kSteps; ++k) {
        StandStop stop{true, 0, direction > 0 ? 0 : 1, direction, k};
        (is_yaw ? stop.sweep_yaw_rad : stop.sweep_tilt_rad) = direction * (50.0 * k - 300.0) * kArcsec;
        clock.Take(stop, run);
      }
    }
  }
}

void GoRound(const StandDesign& d, int setup, Clock& clock, StandRun& run) {
  const double step_rad = 2.0 * M_PI / d.positions,
               shift_rad = d.shifts[static_cast<std::size_t>(setup)] * step_rad;
  for (std::size_t pass = 0; pass < d.passes.size(); ++pass) {
    for (int k = 0; k < d.positions; ++k) {
      StandStop stop{false, setup, static_cast<int>(pass), d.passes[pass],
                     d.passes[pass] > 0 ? k : d.positions - 1 - k};
      stop.target_rad = stop.position * step_rad;
      stop.shift_rad = shift_rad;
      stop.reference_rad = shift_rad - stop.target_rad;
      clock.Take(stop, run);
    }
  }
}

/// Waves of falling size and a rest without order.
std::vector<double> DrawTable(int positions, double rms, Dice& dice) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(positions);
  for (int k = 1; k <= std::min(7, positions / 2); ++k) {
    const double size = dice.Between(0.3, 1.0) / k, phase = dice.Phase();
    for (int i = 0; i < positions; ++i) values[i] += size * std::cos(2.0 * M_PI * k * i / positions + phase);
  }
  for (double& value : values) value += 0.15 * dice.Normal();
  values *= rms / std::sqrt(values.squaredNorm() / positions);
  return {values.begin(), values.end()};
}

std::vector<TableError> DrawErrors(int positions, const TableError& rms, Dice& dice) {
  std::vector<TableError> errors(static_cast<std::size_t>(positions));
  for (double TableError::*part : {&TableError::ex_rad, &TableError::ey_rad, &TableError::ez_rad, &TableError::dx_m,
                                   &TableError::dy_m, &TableError::dz_m}) {
    const std::vector<double> values = DrawTable(positions, rms.*part * dice.Between(0.6, 1.5), dice);
    for (std::size_t i = 0; i < errors.size(); ++i) errors[i].*part = values[i];
  }
  return errors;
}

TableError DrawMounting(double angle_arcsec, double shift_um, Dice& dice) {
  TableError e;
  for (double* angle : {&e.ex_rad, &e.ey_rad, &e.ez_rad}) *angle = angle_arcsec * kArcsec * dice.Normal();
  for (double* shift : {&e.dx_m, &e.dy_m}) *shift = shift_um * kUm * dice.Normal();
  return e;
}

using Eigen::Isometry3d, Eigen::Vector3d;

constexpr double kLines_m = 600e3;
constexpr double kNominalSine = 0.39;  // 650 nm at 600 lines/mm

Isometry3d Turned(double angle_rad) {
  return Isometry3d(Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ()));
}
Isometry3d Moved(double x_m, double y_m, double z_m) {
  return Isometry3d(Eigen::Translation3d(x_m, y_m, z_m));
}

struct Ray {
  Vector3d from, along;
};

Ray LaserRay(const Light& light) {
  const Vector3d from(0.0, 0.2, 0.0);
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(light.laser_yaw_rad, Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(light.laser_pitch_rad, Vector3d::UnitX()))
                                   .toRotationMatrix();
  return {from, turn * Vector3d(0.0, -1.0, 0.0)};
}

Vector3d Meet(const Ray& ray, const Vector3d& point, const Vector3d& normal) {
  return ray.from + ray.along * normal.dot(point - ray.from) / normal.dot(ray.along);
}

/// Order `m`: the tangential part gains m lambda / d along the dispersion, the normal part makes the length one.
Vector3d Diffracted(const Vector3d& in, const Eigen::Matrix3d& R_LG, double m, double wavelength_m) {
  const Vector3d across = R_LG.col(0), normal = R_LG.col(1);
  const Vector3d tangential = in - normal.dot(in) * normal + m * wavelength_m * kLines_m * across;
  return tangential + std::sqrt(1.0 - tangential.squaredNorm()) * normal;
}

/// Place on the detector at `side` = +1 (A) or -1 (B).
Eigen::Vector2d OnDetector(const Ray& ray, double side, double distance_m) {
  const double cosine = std::sqrt(1.0 - kNominalSine * kNominalSine);
  const Vector3d towards(side * kNominalSine, cosine, 0.0), u(cosine, -side * kNominalSine, 0.0);
  const Vector3d p = Meet(ray, distance_m * towards, towards) - distance_m * towards;
  return {p.dot(u), p.z()};
}

}  // namespace

StandRun DrawRun(const StandDesign& design, Dice& dice) {
  StandRun run;
  Clock clock(dice);
  Calibrate(clock, run);
  for (int setup = 0; setup < static_cast<int>(design.shifts.size()); ++setup) {
    clock.Wait(dice.Between(400.0, 800.0));
    GoRound(design, setup, clock, run);
  }
  return run;
}

double Duration_s(const StandRun& run) {
  return run.back().t_s;
}

Stand::Stand(const StandDesign& design, Dice& dice)
    : target_(
          DrawErrors(design.positions, {4 * kArcsec, 4 * kArcsec, 5 * kArcsec, 2 * kUm, 2 * kUm, 0.6 * kUm}, dice)),
      reference_(DrawErrors(design.positions, {5 * kArcsec, 5 * kArcsec, 12 * kArcsec, 2 * kUm, 2 * kUm, 1.5 * kUm},
                            dice)) {
  for (std::size_t s = 0; s < design.shifts.size(); ++s) {
    seat_.push_back(DrawMounting(12.0, 6.0, dice));
    mount_.push_back(DrawMounting(6.0, 3.0, dice));
  }
  mount_.push_back(DrawMounting(15.0, 3.0, dice));
}

std::size_t Stand::PositionOf(double angle_rad) const {
  const auto n = static_cast<int>(target_.size());
  const int k = static_cast<int>(std::lround(angle_rad * n / (2.0 * M_PI)));
  return static_cast<std::size_t>((k % n + n) % n);
}

Eigen::Isometry3d Stand::GratingAt(const StandStop& stop) const {
  if (stop.calibration) {
    TableError sweep{.ex_rad = stop.sweep_tilt_rad, .ez_rad = stop.sweep_yaw_rad};
    return PoseOf(sweep) * PoseOf(mount_.back());
  }
  const auto setup = static_cast<std::size_t>(stop.setup);
  return GratingOn({stop.target_rad, stop.reference_rad, stop.shift_rad, true, target_[PositionOf(stop.target_rad)],
                    reference_[PositionOf(stop.reference_rad)], seat_[setup]}) *
         PoseOf(mount_[setup]);
}

Eigen::MatrixX4d Stand::Spots_m(const StandRun& run, const std::vector<Disturbed>& disturbed) const {
  Eigen::MatrixX4d spots(std::ssize(run), 4);
  for (std::size_t i = 0; i < run.size(); ++i) {
    const Disturbed& d = disturbed[i];
    const Eigen::Isometry3d moved = PoseOf({d.ex_rad, d.ey_rad, d.ez_rad, d.dx_m, 0.0, 0.0});
    const Spots s = ShineOn(moved * GratingAt(run[i]), d.light);
    spots.row(static_cast<Eigen::Index>(i)) << s.u_a_m, s.v_a_m, s.u_b_m, s.v_b_m;
  }
  return spots;
}

Isometry3d PoseOf(const TableError& e) {
  Isometry3d pose = Moved(e.dx_m, e.dy_m, e.dz_m);
  pose.rotate(Eigen::AngleAxisd(e.ez_rad, Vector3d::UnitZ()) * Eigen::AngleAxisd(e.ey_rad, Vector3d::UnitY()) *
              Eigen::AngleAxisd(e.ex_rad, Vector3d::UnitX()));
  return pose;
}

Isometry3d GratingOn(const Stacking& s) {
  const double reseat_rad = s.is_reseated ? -s.shift_rad : 0.0, clamp_rad = s.is_reseated ? 0.0 : s.shift_rad;
  return Moved(0.0, -0.030, -0.130) * PoseOf(s.target) * Turned(s.target_rad) * Moved(0.0, 0.0, 0.080) *
         PoseOf(s.seat) * Turned(reseat_rad) * PoseOf(s.reference) * Turned(s.reference_rad) * Turned(-clamp_rad) *
         Moved(0.0, 0.030, 0.050);
}

Spots ShineOn(const Isometry3d& X_LG, const Light& light) {
  const Ray laser = LaserRay(light);
  const Vector3d spot = Meet(laser, X_LG.translation(), X_LG.linear().col(1));
  const auto order = [&](double m) {
    return Ray{spot, Diffracted(laser.along, X_LG.linear(), m, light.wavelength_m)};
  };
  const Eigen::Vector2d a = OnDetector(order(1.0), 1.0, light.distance_a_m);
  const Eigen::Vector2d b = OnDetector(order(-1.0), -1.0, light.distance_b_m);
  return {a.x(), a.y(), b.x(), b.y()};
}

}  // namespace twinbench::foreign
