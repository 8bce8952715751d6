#include "twin/benches/encoder_comparison/diagnosis/speed_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "twin/core/reading_clock.h"
#include "twin/core/units.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::encoder {
namespace {

/// Delay [s], lag of first order [s], greatest speed [rad/s].
using Servo = std::array<double, 3>;

/// What was commanded and where the device was, over the time.
struct Commanded {
  Eigen::VectorXd time_s, command_rad, device_rad;

  Eigen::Index Readings() const { return time_s.size(); }
  double Step_s() const { return (time_s[Readings() - 1] - time_s[0]) / static_cast<double>(Readings() - 1); }

  /// Later by the delay, straight between readings.
  Eigen::VectorXd Delayed(double delay_s) const {
    Eigen::VectorXd delayed(Readings());
    for (Eigen::Index i = 0, before = 0; i < Readings(); ++i) {
      const double at_s = std::max(time_s[i] - delay_s, time_s[0]);
      while (before + 2 < Readings() && time_s[before + 1] <= at_s) ++before;
      const double share = (at_s - time_s[before]) / (time_s[before + 1] - time_s[before]);
      delayed[i] = command_rad[before] + std::min(share, 1.0) * (command_rad[before + 1] - command_rad[before]);
    }
    return delayed;
  }

  /// @param limited  Steps that the limit cut short are counted here.
  Eigen::VectorXd Followed(const Servo& servo, int& limited) const {
    const auto [delay_s, lag_s, speed_rad_s] = servo;
    const Eigen::VectorXd aim = Delayed(delay_s);
    Eigen::VectorXd at(Readings());
    at[0] = device_rad[0];
    limited = 0;
    for (Eigen::Index i = 1; i < Readings(); ++i) {
      const double step_s = time_s[i] - time_s[i - 1], most_rad = speed_rad_s * step_s;
      const double way_rad = (aim[i] - at[i - 1]) * -std::expm1(-step_s / std::max(lag_s, 1e-3 * step_s));
      limited += std::abs(way_rad) > most_rad ? 1 : 0;
      at[i] = at[i - 1] + std::clamp(way_rad, -most_rad, most_rad);
    }
    return at;
  }

  /// Of a servo without a limit beside a gain of its own: of a triangle one that goes less far looks like one that goes slower.
  double Left(const Servo& servo) const {
    int limited = 0;
    const Eigen::VectorXd followed_rad = Followed(servo, limited);
    if (std::isfinite(servo[2])) return Variance(device_rad - followed_rad);
    const Eigen::VectorXd about_rad = followed_rad.array() - followed_rad.mean();
    return Variance(device_rad - about_rad * (about_rad.dot(device_rad) / about_rad.squaredNorm()));
  }

  static double Variance(const Eigen::VectorXd& rows) { return (rows.array() - rows.mean()).square().mean(); }
};

/// One number a step up or down, if that leaves less.
bool StepBy(const Commanded& all, std::size_t k, double by, Servo& servo, double& left) {
  Servo other = servo;
  other[k] = std::max(0.0, other[k] + by);
  const double of_other = all.Left(other);
  if (!(of_other < left)) return false;
  servo = other;
  left = of_other;
  return true;
}

/// By steps along one number at a time, as long as they help; then by shorter ones.
Servo Moved(const Commanded& all, Servo servo) {
  constexpr int kMost = 30;  // of one length
  double left = all.Left(servo);
  const bool is_limited = std::isfinite(servo[2]);
  for (double length = 1.0; length > 1e-4; length *= 0.5) {
    const Servo by = {2.0 * length * all.Step_s(), 2.0 * length * all.Step_s(), is_limited ? 0.1 * length * servo[2] : 0.0};
    bool is_moved = true;
    for (int round = 0; is_moved && round < kMost; ++round) {
      is_moved = false;
      for (std::size_t k = 0; k < (is_limited ? 3 : 2); ++k)
        is_moved = StepBy(all, k, by[k], servo, left) || StepBy(all, k, -by[k], servo, left) || is_moved;
    }
  }
  return servo;
}

/// What a servo leaves, and it.
using Fit = std::pair<double, Servo>;

/// At each speed the best of some delays and lags; of all speeds the few that leave least.
std::vector<Fit> Starts(const Commanded& all, const std::vector<double>& speeds_rad_s) {
  std::vector<Fit> starts;
  for (const double speed_rad_s : speeds_rad_s) {
    Fit best{std::numeric_limits<double>::infinity(), {}};
    for (double wait_s = 0.5 * all.Step_s(); wait_s < 64.0 * all.Step_s(); wait_s *= 1.6) {
      for (const Servo& servo : {Servo{wait_s, 0.0, speed_rad_s}, Servo{0.0, wait_s, speed_rad_s}})
        best = std::min(best, {all.Left(servo), servo});
    }
    starts.push_back(best);
  }
  constexpr std::size_t kFew = 3;
  std::ranges::sort(starts);
  starts.resize(std::min(starts.size(), kFew));
  return starts;
}

Fit BestFrom(const Commanded& all, std::vector<Fit> starts) {
  for (auto& [left, servo] : starts) {
    servo = Moved(all, servo);
    left = all.Left(servo);
  }
  return std::ranges::min(starts);
}

/// Shares of the greatest speed that was commanded: a limit may be reached for a moment, just below it.
std::vector<double> SpeedsOf(const Commanded& all) {
  double most = 0.0;
  for (Eigen::Index i = 1; i < all.Readings(); ++i)
    most = std::max(most, std::abs(all.command_rad[i] - all.command_rad[i - 1]) / (all.time_s[i] - all.time_s[i - 1]));
  std::vector<double> speeds = {0.98 * most, 0.95 * most, 0.9 * most, 0.85 * most};
  for (double share = 1.0; share > 0.05; share *= 0.8) speeds.push_back(share * most);
  return speeds;
}

bool IsLater(const Eigen::VectorXd& time_s) {
  for (Eigen::Index i = 1; i < time_s.size(); ++i) {
    if (!(time_s[i] > time_s[i - 1])) return false;
  }
  return true;
}

std::vector<Reading> Beside(std::vector<Reading> used, const Eigen::VectorXd& device_rad) {
  for (std::size_t i = 0; i < used.size(); ++i) {
    used[i].reference_rad = device_rad[static_cast<Eigen::Index>(i)];
    used[i].velocity_rad_s = kNaN;
  }
  return used;
}

}  // namespace

std::optional<SpeedLimit> SpeedLimitOf(const std::vector<Reading>& readings, const Scenario& scenario,
                                       const model::FollowMaker& follow) {
  constexpr Eigen::Index kFewest = 50;
  constexpr double kOfDelay = 0.1, kOfError = 0.05, kLimited = 0.01;  // of what each leaves; of the readings
  constexpr int kFewestLimited = 12;
  constexpr double kWorthMoving = 0.7;  // between the speeds that are tried first much is left of a limit, too
  if (!HasClock(readings)) return {};
  SpeedLimit found{BuildRun(readings, scenario, follow), {}, {}};
  const LinearRun& run = found.asked.run;
  const Commanded all{run.schedule.time_s, run.schedule.reference_rad, run.schedule.reference_rad + run.residual};
  const bool is_one_course = found.asked.setups.cols() == 1 && IsLater(all.time_s);
  if (!found.asked.context.Moves() || !is_one_course || all.Readings() < kFewest) return {};
  const std::vector<Fit> starts = Starts(all, SpeedsOf(all)), delays = Starts(all, {std::numeric_limits<double>::infinity()});
  if (!(starts.front().first < kWorthMoving * delays.front().first)) return {};
  const Servo limited = BestFrom(all, starts).second;
  int steps = 0;
  const Eigen::VectorXd allowed_rad = all.Followed(limited, steps);
  const double left = Commanded::Variance(all.device_rad - allowed_rad);
  if (steps < std::max<double>(kFewestLimited, kLimited * static_cast<double>(all.Readings()))) return {};
  if (left > kOfError * Commanded::Variance(run.residual)) return {};
  if (left > kOfDelay * BestFrom(all, delays).first) return {};
  found.allowed = Beside(found.asked.used, allowed_rad);
  found.behind_rad = allowed_rad - all.command_rad;
  found.delay_s = limited[0] + limited[1];
  found.speed_rad_s = limited[2];
  return found;
}

void TellSpeedLimit(const SpeedLimit& limit, DiagnosisRun& result) {
  Diagnosis& d = result.diagnosis;
  const Eigen::VectorXd sigma = result.run.sigma;
  const double rest = result.run.residual.squaredNorm();
  result.run = limit.asked.run;
  result.run.sigma = sigma;
  Accepted behind;
  behind.family.kind = Kind::kUnknown;
  behind.family.effect = "speed limit";
  behind.family.where = "angle";
  behind.family.goes_by_time = true;
  behind.family.amplitudes = {{"strength", "1", 1.0, 1.0}};
  behind.amplitudes = Eigen::VectorXd::Ones(1);
  behind.columns = limit.behind_rad.array() - limit.behind_rad.mean();
  if (rest < tuning::kSmallRest * behind.columns.squaredNorm()) {  // no servo is as exact as its formula
    d.causes.clear();
    d.unknown.signature.clear();
    result.accepted.clear();
  }
  const double rms_rad = std::sqrt(behind.columns.squaredNorm() / result.run.Rows());
  const std::string words = fmt::format(
      "speed limit of {:.3g} {}/s, behind which the device follows {:.2g} s later, function of the command, on angle, "
      "amplitude {:.2g} {}",
      limit.speed_rad_s / result.run.to_SI, result.run.unit, limit.delay_s, std::sqrt(2.0) * rms_rad / result.run.to_SI,
      result.run.unit);
  result.accepted.insert(result.accepted.begin(), std::move(behind));
  d.unknown.signature = words + (d.unknown.signature.empty() ? "" : " | " + d.unknown.signature);
  d.unknown.probability = tuning::kListed;
  d.verdict = Verdict::kUnknown;
}

}  // namespace twinbench::diagnose::encoder
