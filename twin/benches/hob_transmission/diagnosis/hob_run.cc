#include "twin/benches/hob_transmission/diagnosis/hob_run.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "twin/benches/hob_transmission/diagnosis/hob_noise.h"
#include "twin/benches/hob_transmission/diagnosis/outliers.h"
#include "twin/benches/hob_transmission/diagnosis/steady_hob.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/followed.h"
#include "twin/diagnose/mean_of_runs.h"
#include "twin/diagnose/redundancy.h"
#include "twin/model/course.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::hob {
namespace {

constexpr double kWatched = 0.9;  // of the samples; fewer are not worth a channel
constexpr double kFree_rad = 2.0 * units::kPi;

std::vector<Reading> Usable(const std::vector<Reading>& readings) {
  std::vector<Reading> used;
  std::ranges::copy_if(readings, std::back_inserter(used), [](const Reading& r) {
    const bool is_at_rest = r.velocity_rad_s == 0.0;  // stops of the interferometer: no sample of a turn
    return r.status == ReadingStatus::kOk && !is_at_rest && std::isfinite(r.measured_rad) &&
           std::isfinite(r.reference_rad);
  });
  RefuseTooFew(used.size(), readings.size());
  for (const Reading& r : used) {
    if (!std::isfinite(r.head_rad))
      throw InputError("readings", fmt::format("reading {} has no head angle", r.reading),
                       "head_deg in every mounting");
  }
  return used;
}

Eigen::VectorXd Column(const std::vector<Reading>& readings, double Reading::*value) {
  Eigen::VectorXd column(std::ssize(readings));
  for (Eigen::Index i = 0; i < column.size(); ++i) column[i] = readings[static_cast<std::size_t>(i)].*value;
  return column;
}

/// At rest that of the last motion.
Eigen::VectorXd HeldDirection(const std::vector<int>& direction) {
  Eigen::VectorXd held(std::ssize(direction));
  double last = 1.0;
  for (Eigen::Index i = 0; i < held.size(); ++i) {
    const int d = direction[static_cast<std::size_t>(i)];
    held[i] = last = d != 0 ? d : last;
  }
  return held;
}

/// As recorded, else from the samples before and behind of the same pass.
Eigen::VectorXd Velocity_rad_s(const Schedule& s, const Eigen::VectorXd& table_rad) {
  Eigen::VectorXd v = s.velocity_rad_s;
  const int last = s.Readings() - 1;
  for (int i = 0; i <= last; ++i) {
    if (std::isfinite(v[i])) continue;
    const auto at = [&](int k) { return static_cast<std::size_t>(k); };
    const int a = i > 0 && s.pass[at(i - 1)] == s.pass[at(i)] ? i - 1 : i;
    const int b = i < last && s.pass[at(i + 1)] == s.pass[at(i)] ? i + 1 : i;
    const double step_s = s.time_s[b] - s.time_s[a];
    v[i] = step_s > 0.0 ? (table_rad[b] - table_rad[a]) / step_s : 0.0;
  }
  return v;
}

/// Of the samples, by the interferometer.
double ShareWatched(const std::vector<Reading>& used) {
  return Column(used, &Reading::interferometer_rad).array().isFinite().cast<double>().mean();
}

SignalContext ContextOf(const std::vector<Reading>& used, const Scenario& scenario) {
  SignalContext c;
  c.schedule = model::CourseOf(used);
  const Eigen::VectorXd shown_rad = Column(used, &Reading::measured_rad),
                        head_rad = Column(used, &Reading::head_rad);
  const bool from_origin = HobOf(scenario).hob_procedure.encoder_zero == "table_origin";
  c.table_rad = from_origin ? shown_rad : shown_rad + head_rad;
  c.ring_rad = c.table_rad - head_rad;
  c.hob_rad = Column(used, &Reading::reference_rad);
  c.velocity_rad_s = Velocity_rad_s(c.schedule, c.table_rad);
  c.direction = HeldDirection(c.schedule.direction);
  c.train = HobOf(scenario).transmission;
  c.steady_hob_rad = SteadyHob_rad(c);
  c.schedule.target_rad = c.table_rad;
  c.schedule.velocity_rad_s = c.velocity_rad_s;
  c.hob_lines = HobOf(scenario).hob_encoder.lines;
  c.ramp_s = HobOf(scenario).hob_procedure.ramp_s;
  c.channels = ShareWatched(used) > kWatched ? 2 : 1;
  c.groups = GroupsOf(c.schedule, 1);
  return c;
}

/// Samples to be taken together: most, but the lines of worm and mesh stay, and so do the folded ones of the hob's
/// signals as far as they can.
Grouping ChooseGroups(const SignalContext& c) {
  constexpr int kMost = 64;
  constexpr double kLines = 0.8, kSignals = 0.5;
  const double highest = std::max({c.train.WormOrder(), static_cast<double>(c.train.gear_teeth), 60.0});
  const Eigen::VectorXd line_rad = highest * c.table_rad, signal_rad = 2.0 * HobSignalPhase_rad(c);
  Grouping groups = GroupsOf(c.schedule, 1);
  for (int size = 2; size <= kMost; ++size) {
    Grouping larger = GroupsOf(c.schedule, size);
    if (KeptByMean(line_rad, larger) < kLines) break;
    if (KeptByMean(signal_rad, larger) >= kSignals) groups = std::move(larger);
  }
  return groups;
}

/// Samples x channels.
Eigen::MatrixXd AsRead_rad(const std::vector<Reading>& used, const SignalContext& c) {
  Eigen::MatrixXd read_rad(c.Samples(), c.channels);
  read_rad.col(0) = c.table_rad - c.train.Ratio() * c.hob_rad;
  if (c.channels > 1) read_rad.col(1) = Column(used, &Reading::interferometer_rad);
  return read_rad;
}

/// Each column without the means of its set-ups.
Eigen::MatrixXd WithoutConstants(const SignalContext& c, Eigen::MatrixXd left_rad) {
  const Eigen::MatrixXd setups = SetUps(c);
  for (Eigen::Index k = 0; k < left_rad.cols(); ++k) {
    const Eigen::VectorXd there = left_rad.col(k).array().isFinite().cast<double>();
    const Eigen::VectorXd values = left_rad.col(k).array().isFinite().select(left_rad.col(k), 0.0);
    const Eigen::ArrayXd count = (setups.transpose() * there).array().max(1.0);
    left_rad.col(k) -= setups * ((setups.transpose() * values).array() / count).matrix();
  }
  return left_rad;
}

/// Motion of the table by its free orders.
struct FreeMotion {
  Eigen::MatrixXd waves;  // samples x [cosine, sine of each order]
  Eigen::VectorXd sizes_rad;
  Eigen::VectorXd Motion_rad() const { return waves * sizes_rad; }
};

Eigen::MatrixXd FreeWaves(const SignalContext& c, const Eigen::VectorXd& gear_rad) {
  Eigen::MatrixXd waves(c.Samples(), 2 * c.train.free_orders);
  for (int k = 1; k <= c.train.free_orders; ++k) waves.middleCols(2 * k - 2, 2) = model::Wave(k * gear_rad);
  return waves;
}

/// Of what both encoders show, by least squares.
/// @param gear_rad  Angle by turns of which the gears err.
FreeMotion FitFreeOrders(const SignalContext& c, const Eigen::VectorXd& gear_rad,
                         const Eigen::VectorXd& centred_rad) {
  FreeMotion free{FreeWaves(c, gear_rad), {}};
  const Eigen::MatrixXd normal = free.waves.transpose() * free.waves;
  free.sizes_rad = normal.ldlt().solve(free.waves.transpose() * centred_rad);
  return free;
}

/// What is left of each sample by the twin that follows the record, without the constants of the set-ups: samples x
/// channels; NaN where the interferometer saw nothing. The twin is asked again with the free orders that fit, which
/// are then put back.
Eigen::MatrixXd Left_rad(const std::vector<Reading>& used, const SignalContext& c, const Eigen::VectorXd& gear_rad,
                         const Followed& twin) {
  const Eigen::MatrixXd read_rad = AsRead_rad(used, c);
  const auto left_with = [&](const Eigen::VectorXd& motion_rad) -> Eigen::MatrixXd {
    const Eigen::MatrixXd told_rad = twin.Predict({{"transmission", motion_rad}}).leftCols(c.channels);
    return WithoutConstants(c, read_rad - told_rad + motion_rad.replicate(1, c.channels));
  };
  const Eigen::MatrixXd first_rad = left_with(Eigen::VectorXd::Zero(c.Samples()));
  return left_with(FitFreeOrders(c, gear_rad, first_rad.col(0)).Motion_rad());
}

/// [orders of the table, shared by the channels; constants of set-up and channel].
Nuisance FreeUnknowns(const SignalContext& c, const Eigen::VectorXd& gear_rad) {
  const int orders = c.train.free_orders;
  const Eigen::MatrixXd setups = AsRows(c, SetUps(c), ShownBy::kByBoth),
                        motion = AsRows(c, FreeWaves(c, gear_rad), ShownBy::kByBoth);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(motion.rows(), 2 * orders + setups.cols() * c.channels);
  dense.leftCols(2 * orders) = motion;
  for (Eigen::Index row = 0; row < dense.rows(); ++row)
    dense.row(row).segment(2 * orders + row % c.channels * setups.cols(), setups.cols()) = setups.row(row);
  return {dense.sparseView(), Eigen::VectorXd::Constant(dense.cols(), 1.0 / (kFree_rad * kFree_rad)), 0, 0};
}

LinearRun RunOf(const SignalContext& c, const Eigen::MatrixXd& left_rad, const Eigen::VectorXd& gear_rad,
                const Scenario& scenario) {
  LinearRun run;
  run.bench = scenario.bench;
  run.schedule = Grouped(c.schedule, c.groups);
  run.channels = {kTransmission};
  if (c.channels > 1) run.channels.emplace_back(kInterferometer);
  for (int k = 0; k < c.channels; ++k)
    run.patterns.push_back({run.channels[static_cast<std::size_t>(k)], Eigen::VectorXd::Unit(c.channels, k)});
  run.unit = "arcsec";
  run.to_SI = units::arcsec;
  run.noise_free = scenario.noise_free;
  SetResidual(c, left_rad, scenario, run);
  run.observed = run.residual;  // of m nothing else is of interest: it has no scale of its own
  run.nuisance = FreeUnknowns(c, gear_rad);
  return run;
}

/// The table's angle as its encoder shows it is off by the encoder's error; as the hob drives it, it is that by
/// which gears err.
Eigen::VectorXd DrivenTable_rad(const SignalContext& c) {
  return c.table_rad - WithoutConstants(c, c.table_rad - c.train.Ratio() * c.hob_rad);
}

double SecondOrder_rad(const SignalContext& c) {
  const Eigen::VectorXd m_rad = WithoutConstants(c, c.table_rad - c.train.Ratio() * c.hob_rad);
  const Eigen::MatrixXd fast_rad = WithoutConstants(c, m_rad - FitFreeOrders(c, c.table_rad, m_rad).Motion_rad());
  const double highest = std::max(c.train.WormOrder(), static_cast<double>(c.train.gear_teeth));
  return model::Rms(fast_rad.col(0)) * highest * model::Rms(m_rad);
}

}  // namespace

HobRun BuildRun(const std::vector<Reading>& readings, const Scenario& scenario, const model::FollowMaker& follow) {
  std::vector<Reading> used = Usable(readings);
  HobRun hob;
  const auto gear_rad = [&] { return DrivenTable_rad(hob.context); };
  const auto left_of_used = [&]() -> Eigen::MatrixXd {
    return Left_rad(used, hob.context, gear_rad(), Followed(follow, scenario, readings, used));
  };
  hob.left_out = static_cast<int>(std::ssize(readings) - std::ssize(used));
  hob.context = ContextOf(used, scenario);
  Eigen::MatrixXd left_rad = left_of_used();
  hob.outliers = FindOutliers(hob.context, left_rad.col(0));
  if (!hob.outliers.readings.empty()) {
    std::erase_if(used, [&](const Reading& r) { return std::ranges::count(hob.outliers.readings, r.reading) > 0; });
    hob.context = ContextOf(used, scenario);
    left_rad = left_of_used();
  }
  hob.context.groups = ChooseGroups(hob.context);
  hob.run = RunOf(hob.context, left_rad, gear_rad(), scenario);
  ScaleToMean(used, hob.run);
  hob.second_order_rad = SecondOrder_rad(hob.context);
  return hob;
}

std::string BiasInWords(int free_orders, const Eigen::VectorXd& unknowns) {
  constexpr double kWorthTelling_rad = 1e-3 * units::arcsec;
  std::string words;
  for (int k = 1; k <= free_orders; ++k) {
    const double size_rad = unknowns.segment<2>(2 * k - 2).norm();
    if (size_rad < kWorthTelling_rad) continue;
    words += fmt::format("{}transmission order {} up to {:.2g} arcsec", words.empty() ? "" : ", ", k,
                         size_rad / units::arcsec);
  }
  return words.empty() ? "nothing but the constant of a mounting" : words;
}

double RowSpacing_rad(const SignalContext& c) {
  const Schedule rows = Grouped(c.schedule, c.groups);
  const double step_rad = model::TypicalStep_rad(rows, rows.target_rad);
  return step_rad > 0.0 ? step_rad : units::turn;
}

int LargestOrder(const SignalContext& c) {
  return model::HighestOrder(RowSpacing_rad(c));
}

}  // namespace twinbench::diagnose::hob
