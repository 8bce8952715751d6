#include "tests/foreign/stand_run.h"

#include <cmath>

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
    TableError sweep;
    sweep.ez_rad = stop.sweep_yaw_rad;
    sweep.ex_rad = stop.sweep_tilt_rad;
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

}  // namespace twinbench::foreign
