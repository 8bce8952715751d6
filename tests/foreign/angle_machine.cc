#include "tests/foreign/plans.h"
#include "tests/support/twin_run.h"

namespace twinbench::foreign {
namespace {

/// A fault at its size.
struct SizedFault {
  AngleFault fault;
  double size;
};

struct AngleMachine {
  std::uint64_t seed;
  AngleDesign design;
  double noise_deg, offset_deg;
  NoiseShape shape;
  std::vector<SizedFault> faults;
};

double Length(const Eigen::VectorXd& shown) {
  return (shown.array() - shown.mean()).matrix().norm();
}

SizedFault Sized(const AngleFault& fault, const Track& example, double length_deg) {
  const auto length = [&](double size) { return Length(fault.shown_deg(example, size)); };
  return {fault, SizeOfLength(length_deg, fault.smallest, fault.largest, length)};
}

Scenario Believed(bool in_motion) {
  return LoadScenario(test::ScenarioPath("encoder_comparison.toml"),
                      {std::string("encoder_procedure.kind=") + (in_motion ? "sweep" : "stops")});
}

Reading ReadingOf(const Instant& at, int number) {
  return {.reading = number, .time = Time(FromSeconds(at.t_s)), .pass = at.pass, .direction = at.direction,
          .position = at.position, .reference_rad = at.angle_deg * units::deg,
          .temperature_degC = Quantised(at.temperature_degC, 0.001), .velocity_rad_s = at.speed_deg_s * units::deg};
}

Eigen::VectorXd ShownErrors_deg(const AngleMachine& m, const Track& track, const Run& run) {
  Eigen::VectorXd shown = Eigen::VectorXd::Constant(std::ssize(track), m.offset_deg);
  if (run.faults) {
    for (const SizedFault& f : m.faults) shown += f.fault.shown_deg(track, f.size);
  }
  NoiseSeries noise(m.shape, Dice(m.seed + run.seed, "angle noise"));
  for (double& value : shown) value += run.noise ? m.noise_deg * noise.Next() : 0.0;
  return shown;
}

std::vector<Reading> ReadingsOf(const AngleMachine& m, const Run& run) {
  Dice course(m.seed + run.seed, "angle course"), losses(m.seed + run.seed, "lost rows");
  const Track track = DrawTrack(m.design, course);
  const Eigen::VectorXd shown_deg = ShownErrors_deg(m, track, run);
  std::vector<Reading> readings;
  for (std::size_t i = 0; i < track.size(); ++i) {
    if (losses.Between(0.0, 1.0) < m.shape.missing) continue;
    Reading r = ReadingOf(track[i], static_cast<int>(i));
    const double shown = track[i].angle_deg + shown_deg[static_cast<Eigen::Index>(i)];
    r.measured_rad = Quantised(shown, m.shape.step * m.noise_deg) * units::deg;
    readings.push_back(r);
  }
  return readings;
}

AngleMachine Drawn(std::uint64_t seed, bool in_motion, Dice& dice) {
  const AngleDesign design = in_motion ? DrawMotion(dice) : DrawStops(dice);
  const double noise_deg = dice.Sized(0.001, 0.004), offset_deg = dice.Between(-20.0, 20.0);
  // Half of the devices show zero where the reference does.
  return {seed, design, noise_deg, dice.Sign() > 0.0 ? offset_deg : 0.0, {}, {}};
}

Machine Finished(const Truth& truth, const AngleMachine& m) {
  return {truth, Believed(m.design.in_motion), [m](const Run& run) { return ReadingsOf(m, run); }};
}

/// The room of one run: two slow waves and a trend.
class Room {
 public:
  explicit Room(Dice& dice)
      : offset_K_(dice.Between(-0.3, 0.3)),
        slope_K_s_(dice.Between(-1e-4, 1e-4)),
        fast_{dice.Between(0.05, 0.2), dice.Sized(300.0, 900.0), dice.Phase()},
        slow_{dice.Between(0.2, 0.6), dice.Sized(1500.0, 6000.0), dice.Phase()} {}
  double At(double t_s) const { return 20.0 + offset_K_ + slope_K_s_ * t_s + Of(fast_, t_s) + Of(slow_, t_s); }

 private:
  struct Wave {
    double size_K, period_s, phase;
  };
  static double Of(const Wave& w, double t_s) {
    return w.size_K * std::sin(2.0 * M_PI * t_s / w.period_s + w.phase);
  }
  double offset_K_, slope_K_s_;
  Wave fast_, slow_;
};

/// Travel and time behind the last reversal, along the readings.
void AddHistory(Track& track) {
  double travelled_deg = 0.0, reversal_deg = 0.0, reversal_s = track.front().t_s;
  int sense = track.front().direction == 0 ? 1 : track.front().direction;
  for (std::size_t i = 0; i < track.size(); ++i) {
    const double step_deg = i == 0 ? 0.0 : track[i].angle_deg - track[i - 1].angle_deg;
    if (step_deg * sense < 0.0) {
      sense = -sense;
      reversal_deg = travelled_deg;
      reversal_s = track[i - 1].t_s;
    }
    travelled_deg += std::abs(step_deg);
    track[i].sense = sense;
    track[i].travelled_deg = travelled_deg;
    track[i].since_reversal_deg = travelled_deg - reversal_deg;
    track[i].since_reversal_s = track[i].t_s - reversal_s;
  }
}

void AddRoom(Dice& dice, Track& track) {
  const Room room(dice);
  for (Instant& at : track) at.temperature_degC = room.At(at.t_s);
}

Track Stops(const AngleDesign& d, Dice& dice) {
  Track track;
  const double step_deg = 360.0 / d.stops_per_turn, turns = d.turns * dice.Between(0.96, 1.0);
  const int stops = static_cast<int>(d.stops_per_turn * turns);
  double t_s = dice.Between(0.5, 4.0);
  for (std::size_t pass = 0; pass < d.passes.size(); ++pass) {
    for (int k = 0; k < stops; ++k) {
      const int position = d.passes[pass] > 0 ? k : stops - 1 - k;
      const double off = d.jitter * dice.Between(-0.5, 0.5);
      track.push_back(
          {t_s, d.start_deg + (position + off) * step_deg, 0.0, d.passes[pass], static_cast<int>(pass), position});
      t_s += d.interval_s * (1.0 + d.jitter * dice.Between(-1.0, 1.0));
    }
    t_s += d.interval_s * dice.Between(0.0, 3.0);
  }
  return track;
}

/// Speed and travel of a pass that starts and ends smoothly, in units of its full speed.
class Glide {
 public:
  Glide(double path_s, double ramp_s) : ramp_s_(ramp_s), steady_s_(std::max(0.0, path_s - ramp_s)) {}
  double Duration() const { return 2.0 * ramp_s_ + steady_s_; }
  double Speed(double t_s) const {
    if (t_s <= 0.0 || t_s >= Duration()) return 0.0;
    return Rise(std::min({1.0, t_s / ramp_s_, (Duration() - t_s) / ramp_s_}));
  }
  double Travel(double t_s) const {
    if (t_s <= 0.0) return 0.0;
    if (t_s > 0.5 * Duration()) return ramp_s_ + steady_s_ - Travel(Duration() - t_s);
    const double x = std::min(1.0, t_s / ramp_s_);
    return ramp_s_ * x * x * x * (1.0 - 0.5 * x) + std::max(0.0, t_s - ramp_s_);
  }

 private:
  static double Rise(double x) { return x * x * (3.0 - 2.0 * x); }
  double ramp_s_, steady_s_;
};

Track Motion(const AngleDesign& d, Dice& dice) {
  Track track;
  double angle_deg = d.start_deg, begin_s = dice.Between(0.1, 1.0), t_s = begin_s;
  for (std::size_t pass = 0; pass < d.passes.size(); ++pass) {
    const double speed_deg_s = d.speeds_deg_s[pass % d.speeds_deg_s.size()] * dice.Between(0.97, 1.03);
    const Glide glide(360.0 * d.turns / speed_deg_s, dice.Between(0.5, 1.2));
    const double end_s = begin_s + glide.Duration() + dice.Between(0.5, 2.0);
    for (int position = 0; t_s < end_s; ++position) {
      const double v = d.passes[pass] * speed_deg_s * glide.Speed(t_s - begin_s);
      const int direction = v == 0.0 ? 0 : d.passes[pass];
      track.push_back({t_s, angle_deg + d.passes[pass] * speed_deg_s * glide.Travel(t_s - begin_s), v, direction,
                       static_cast<int>(pass), position});
      t_s += d.interval_s * (1.0 + d.jitter * dice.Between(-1.0, 1.0));
    }
    angle_deg += d.passes[pass] * speed_deg_s * glide.Travel(glide.Duration());
    begin_s = end_s;
  }
  return track;
}

}  // namespace

Machine MakeAngleMachine(std::uint64_t seed, bool in_motion, const std::vector<Wanted<AngleKind>>& wanted) {
  Dice dice(seed, "angle machine"), course(seed + 1, "angle course");
  AngleMachine m = Drawn(seed, in_motion, dice);
  const Track example = DrawTrack(m.design, course);  // that of the first run
  Truth truth;
  for (const Wanted<AngleKind>& w : wanted) {
    AngleFault fault = w.kind.draw(dice, example);
    fault.truth.kind = w.kind.name;
    Append(fault.truth, truth);
    m.faults.push_back(Sized(fault, example, w.rho * m.noise_deg));
  }
  return Finished(truth, m);
}

Machine MakeAngleInOrder(std::uint64_t seed, bool in_motion, const NoiseShape& noise, int stops_per_turn) {
  Dice dice(seed, "angle machine");
  AngleMachine m = Drawn(seed, in_motion, dice);
  m.shape = noise;
  if (stops_per_turn > 0) {
    m.design.stops_per_turn = stops_per_turn;
    m.design.turns = 1.0;
  }
  return Finished({.kind = "in order"}, m);
}

AngleDesign DrawStops(Dice& dice) {
  return {.stops_per_turn = 1.0 * dice.Whole(41, 83), .turns = dice.Between(1.2, 2.2),
          .start_deg = dice.Between(-170.0, 170.0),
          .passes = dice.OneOf(std::vector<std::vector<int>>{{1, -1, -1, 1}, {1, -1, 1, -1}, {-1, 1, 1, -1}}),
          .interval_s = dice.Between(3.0, 6.0)};
}

AngleDesign DrawMotion(Dice& dice) {
  AngleDesign d{.in_motion = true, .turns = dice.Between(1.3, 2.2), .start_deg = dice.Between(-170.0, 170.0),
                .passes = {1, -1, 1, -1}};
  const double fast_deg_s = dice.Between(25.0, 60.0), slow_deg_s = fast_deg_s / dice.Between(2.0, 3.5);
  d.speeds_deg_s = {fast_deg_s, fast_deg_s, slow_deg_s, slow_deg_s};
  const double duration_s = 720.0 * d.turns * (1.0 / fast_deg_s + 1.0 / slow_deg_s);
  d.interval_s = duration_s / dice.Between(700.0, 1100.0);
  return d;
}

Track DrawTrack(const AngleDesign& design, Dice& dice) {
  Track track = design.in_motion ? Motion(design, dice) : Stops(design, dice);
  AddHistory(track);
  AddRoom(dice, track);
  return track;
}

double Duration_s(const Track& track) {
  return track.back().t_s;
}

}  // namespace twinbench::foreign
