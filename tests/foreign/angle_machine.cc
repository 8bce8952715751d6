#include "tests/foreign/machines.h"
#include "tests/support/twin_run.h"
#include "twin/benches/names.h"

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
  Reading r;
  r.reading = number;
  r.time = Time(FromSeconds(at.t_s));
  r.pass = at.pass;
  r.direction = at.direction;
  r.position = at.position;
  r.reference_rad = at.angle_deg * units::deg;
  r.velocity_rad_s = at.speed_deg_s * units::deg;
  r.temperature_degC = Quantised(at.temperature_degC, 0.001);
  return r;
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

}  // namespace

Machine MakeAngleMachine(std::uint64_t seed, bool in_motion, const std::vector<WantedFault>& wanted) {
  Dice dice(seed, "angle machine"), course(seed + 1, "angle course");
  AngleMachine m = Drawn(seed, in_motion, dice);
  const Track example = DrawTrack(m.design, course);  // that of the first run
  Truth truth;
  for (const WantedFault& w : wanted) {
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

}  // namespace twinbench::foreign
