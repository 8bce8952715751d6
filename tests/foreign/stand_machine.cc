#include <fmt/ranges.h>

#include "tests/foreign/plans.h"
#include "tests/support/twin_run.h"

namespace twinbench::foreign {
namespace {

constexpr double kNoise_m = 0.3e-6;  // 6 mV a sample, 100 samples, 2000 V/m
constexpr double kVoltsPerMetre = 2000.0;
constexpr int kSamples = 100;

struct SizedFault {
  StandFault fault;
  double size;
};

struct StandMachine {
  std::uint64_t seed;
  StandDesign design;
  Stand stand;
  NoiseShape shape;
  std::vector<SizedFault> faults;
};

Eigen::MatrixX4d Shown_m(const Stand& stand, const StandRun& run, const std::vector<SizedFault>& faults) {
  std::vector<Disturbed> disturbed(run.size());
  for (const SizedFault& f : faults) {
    if (f.fault.of_body) f.fault.of_body(run, f.size, disturbed);
  }
  Eigen::MatrixX4d shown_m = stand.Spots_m(run, disturbed);
  for (const SizedFault& f : faults) {
    if (f.fault.of_electronics) f.fault.of_electronics(run, f.size, shown_m);
  }
  return shown_m;
}

/// Of a change of what is shown: the constants of calibration and set-ups are free, and out.
double Length(const Eigen::MatrixX4d& change_m, const StandRun& run) {
  std::map<int, std::vector<Eigen::Index>> blocks;
  for (std::size_t i = 0; i < run.size(); ++i)
    blocks[run[i].calibration ? -1 : run[i].setup].push_back(static_cast<Eigen::Index>(i));
  double power = 0.0;
  for (const auto& [block, rows] : blocks) {
    const Eigen::MatrixX4d part = change_m(rows, Eigen::all);
    power += (part.rowwise() - part.colwise().mean()).squaredNorm();
  }
  return std::sqrt(power);
}

SizedFault Sized(const StandFault& fault, const Stand& stand, const StandRun& run, double length_m) {
  const Eigen::MatrixX4d without_m = Shown_m(stand, run, {});
  const auto length = [&](double size) { return Length(Shown_m(stand, run, {{fault, size}}) - without_m, run); };
  return {fault, SizeOfLength(length_m, fault.smallest, fault.largest, length)};
}

Scenario Believed(const StandDesign& design) {
  return LoadScenario(test::ScenarioPath("rotary_4dof.toml"),
                      {"mechanics.fidelity=kinematic", fmt::format("procedure.positions={}", design.positions),
                       fmt::format("procedure.shifts=[{}]", fmt::join(design.shifts, ", "))});
}

Reading ReadingOf(const StandStop& at, int number) {
  return {.reading = number, .time = Time(FromSeconds(at.t_s)), .setup = at.setup, .pass = at.pass,
          .direction = at.direction, .position = at.position,
          .phase = at.calibration ? Phase::kCalibration : Phase::kFullCircle, .target_rad = at.target_rad,
          .reference_rad = at.reference_rad, .n_samples = kSamples, .dwell_s = at.dwell_s,
          .temperature_degC = Quantised(at.temperature_degC, 0.001)};
}

/// All that is random in the readings of one run.
class Electronics {
 public:
  Electronics(const StandMachine& m, const Run& run)
      : shape_(m.shape), noisy_(run.noise), dice_(m.seed + run.seed, "blocks") {
    for (const char* channel : kChannelNames) series_.emplace_back(m.shape, Dice(m.seed + run.seed, channel));
  }
  void Read(const Eigen::RowVector4d& shown_m, Reading& r) {
    const double noise_V = kNoise_m * kVoltsPerMetre;
    for (std::size_t c = 0; c < kChannels; ++c) {
      const double noise = noisy_ ? noise_V * series_[c].Next() : 0.0;
      r.mean_V[c] =
          Quantised(kVoltsPerMetre * shown_m[static_cast<Eigen::Index>(c)] + noise, shape_.step * noise_V);
      const double scatter = noisy_ ? std::sqrt(dice_.ChiSquared(kSamples - 1.0) / (kSamples - 1.0)) : 1.0;
      r.std_V[c] = std::sqrt(kSamples) * noise_V * scatter;
    }
  }
  void ReadAutocollimator(const StandStop& at, Reading& r) {
    const double noise_rad = noisy_ ? 0.02 * units::arcsec : 0.0;
    r.autocollimator_yaw_rad = at.sweep_yaw_rad + noise_rad * dice_.Normal();
    r.autocollimator_tilt_rad = at.sweep_tilt_rad + noise_rad * dice_.Normal();
  }

 private:
  NoiseShape shape_;
  bool noisy_;
  Dice dice_;
  std::vector<NoiseSeries> series_;
};

std::vector<Reading> ReadingsOf(const StandMachine& m, const Run& run) {
  Dice course(m.seed + run.seed, "stand course"), losses(m.seed + run.seed, "lost rows");
  const StandRun stops = DrawRun(m.design, course);
  const Eigen::MatrixX4d shown_m = Shown_m(m.stand, stops, run.faults ? m.faults : std::vector<SizedFault>{});
  Electronics electronics(m, run);
  std::vector<Reading> readings;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    Reading r = ReadingOf(stops[i], static_cast<int>(i));
    electronics.Read(shown_m.row(static_cast<Eigen::Index>(i)), r);
    if (stops[i].calibration) electronics.ReadAutocollimator(stops[i], r);
    if (losses.Between(0.0, 1.0) >= m.shape.missing) readings.push_back(r);
  }
  return readings;
}

StandMachine Drawn(std::uint64_t seed, const StandDesign& design, const NoiseShape& noise) {
  Dice dice(seed, "stand");
  return {seed, design, Stand(design, dice), noise, {}};
}

Machine Finished(const Truth& truth, const StandMachine& m) {
  return {truth, Believed(m.design), [m](const Run& run) { return ReadingsOf(m, run); }};
}

}  // namespace

Machine MakeStand(std::uint64_t seed, const std::vector<Wanted<StandKind>>& wanted) {
  Dice dice(seed, "stand faults"), course(seed + 1, "stand course");
  StandMachine m = Drawn(seed, {}, {});
  const StandRun example = DrawRun(m.design, course);
  Truth truth;
  for (const Wanted<StandKind>& w : wanted) {
    StandFault fault = w.kind.draw(dice, example);
    fault.truth.kind = w.kind.name;
    Append(fault.truth, truth);
    m.faults.push_back(Sized(fault, m.stand, example, w.rho * kNoise_m));
  }
  return Finished(truth, m);
}

Machine MakeStandInOrder(std::uint64_t seed, const NoiseShape& noise, int positions) {
  StandDesign design;
  design.positions = positions;
  if (positions < 12) design.shifts = {0, 1, 3, positions - 2};
  return Finished({.kind = "in order"}, Drawn(seed, design, noise));
}

}  // namespace twinbench::foreign
