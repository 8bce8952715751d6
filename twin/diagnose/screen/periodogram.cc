#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "twin/core/distributions.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/textbook.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::screen {
namespace {

/// What a wave may follow, and the waves that are looked for: multiples of a step.
struct Along {
  std::string name;    // "time", "target angle"
  Eigen::VectorXd at;  // by reading
  double step = kNaN;  // radians a unit of `at`
  int count = 0;
};

bool Varies(const Eigen::VectorXd& values) {
  return values.size() > 8 && values.allFinite() && values.maxCoeff() > values.minCoeff();
}

/// Steps of half a cycle over the run, wider ones in long runs, up to the Nyquist frequency of the median interval.
void AddTime(const Eigen::VectorXd& time_s, std::vector<Along>& all) {
  constexpr double kMostWaves = 8192.0;
  if (!Varies(time_s)) return;
  const Eigen::VectorXd interval_s = time_s.tail(time_s.size() - 1) - time_s.head(time_s.size() - 1);
  const double nyquist_Hz = 0.5 / std::max(Median({interval_s.begin(), interval_s.end()}), 1e-12);
  const double span_s = time_s.maxCoeff() - time_s.minCoeff();
  const double count = std::clamp(std::ceil(2.0 * nyquist_Hz * span_s), 1.0, kMostWaves);
  all.push_back({"time", time_s.array() - time_s[0], units::turn * nyquist_Hz / count, static_cast<int>(count)});
}

/// Whole orders, of an axis that turns more than twice also half ones, up to half the number of different angles.
void AddAngle(const std::string& name, const Eigen::VectorXd& angle_rad, std::vector<Along>& all) {
  constexpr int kMostOrders = 1000;
  if (!Varies(angle_rad)) return;
  const double span_rad = angle_rad.maxCoeff() - angle_rad.minCoeff();
  if (span_rad < 0.5 * units::turn) return;
  std::set<long> different;
  for (const double turns : Eigen::VectorXd(angle_rad / units::turn))
    different.insert(std::lround((turns - std::floor(turns)) * 1e4) % 10000);
  const int orders = std::min(kMostOrders, (static_cast<int>(different.size()) - 1) / 2);
  const int steps = span_rad > 2.0 * units::turn ? 2 : 1;
  if (orders > 0) all.push_back({name, angle_rad, 1.0 / steps, steps * orders});
}

std::vector<Along> AllAlong(const Schedule& schedule) {
  std::vector<Along> all;
  AddTime(schedule.time_s, all);
  AddAngle("target angle", schedule.target_rad, all);
  AddAngle("reference angle", schedule.reference_rad, all);
  return all;
}

constexpr double kAbsorbed = 1e-3;  // the power of waves that the free unknowns take up is less, and says nothing

/// Powers along one argument of one channel.
struct Powers {
  Along along;
  int channel = 0;
  LombScargle of;
};

std::vector<Powers> AllPowers(const Judged& judged) {
  std::vector<Powers> all;
  const std::vector<int> channels = judged.Channels(8);
  for (const Along& along : AllAlong(judged.run.schedule)) {
    for (const int c : channels) {
      Eigen::VectorXd at(std::ssize(judged.rows[c]));
      for (Eigen::Index k = 0; k < at.size(); ++k) at[k] = along.at[judged.run.ReadingOf(judged.rows[c][k])];
      all.push_back({along, c, {at, along.step, along.count}});
    }
  }
  return all;
}

/// Amplitude of a wave on one channel beside the free unknowns, which may take a part of it up, SI.
double Amplitude_SI(const Judged& judged, int channel, const Eigen::VectorXd& phase_rad,
                    const Eigen::VectorXd& residual) {
  const LinearRun& run = judged.run;
  Eigen::MatrixXd wave = Eigen::MatrixXd::Zero(run.Rows(), 2);
  wave(Eigen::seqN(channel, run.schedule.Readings(), run.Channels()), Eigen::all) = model::Wave(phase_rad);
  const Eigen::MatrixXd white = judged.noise.Whiten(run, wave), absorbed = judged.projector.Absorbed(white);
  return SolveShortest(Eigen::MatrixXd(white.transpose() * white - absorbed.transpose() * absorbed),
                       Eigen::VectorXd(white.transpose() * residual))
      .norm();
}

std::string WaveInWords(const Along& along, double per_unit) {
  if (along.name != "time") return fmt::format("order {:g} of the {}", per_unit, along.name);
  return fmt::format("a wave of {:.4g} mHz (period {:.4g} s)", 1e3 * per_unit / units::turn,
                     units::turn / per_unit);
}

void TellWave(const Judged& judged, const Powers& powers, const Eigen::VectorXd& residual, ResidualTest& test) {
  const Along& along = powers.along;
  Eigen::Index strongest = 0;
  test.statistic = powers.of.Of(judged.Normalised(residual, powers.channel)).col(0).maxCoeff(&strongest);
  const double per_unit = along.step * static_cast<double>(strongest + 1);
  SetEffect(judged.run, powers.channel, Amplitude_SI(judged, powers.channel, per_unit * along.at, residual), test);
  test.reading = fmt::format("residual of {} follows {}, power {:.1f}: {}", judged.run.channels[powers.channel],
                             WaveInWords(along, per_unit), test.statistic,
                             along.name == "time"
                                 ? "a slow change, a cycle of the environment, or vibration aliased by the readings"
                                 : "eccentricity, bearing, gear or encoder of that axis");
}

}  // namespace

/// Lomb and Scargle's, of each channel along time and each angle.
std::optional<Test> Periodogram(const Judged& judged) {
  const auto powers = std::make_shared<const std::vector<Powers>>(AllPowers(judged));
  if (powers->empty()) return std::nullopt;
  Test test{.name = "periodogram"};
  for (const Powers& of : *powers)
    test.items.push_back(judged.run.channels[of.channel] + " along the " + of.along.name);
  test.scores = [&judged, powers](const Eigen::MatrixXd& residual) {
    Eigen::MatrixXd scores(std::ssize(*powers), residual.cols());
    for (Eigen::Index k = 0; k < scores.rows(); ++k) {
      const Powers& of = (*powers)[k];
      scores.row(k) =
          of.of.Of(judged.Normalised(residual, of.channel)).colwise().maxCoeff().array().max(kAbsorbed).log();
    }
    return scores;
  };
  test.tell = [&judged, powers](int item, const Eigen::VectorXd& residual, ResidualTest& told) {
    TellWave(judged, (*powers)[item], residual, told);
  };
  return test;
}

}  // namespace twinbench::diagnose::screen
