#include "twin/diagnose/shown.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "twin/core/bench_format.h"
#include "twin/core/units.h"
#include "twin/diagnose/at.h"
#include "twin/diagnose/bins.h"
#include "twin/diagnose/engine/projector.h"
#include "twin/diagnose/words.h"

namespace twinbench::diagnose {
namespace {

/// What each accepted term explains, and what can be explained at all, in units of noise.
struct Powers {
  std::vector<double> explained;
  double removable = 0.0;
};

/// @param before  W y of the raw rows: the residual once the unknowns have been fitted.
Powers PowersOf(const DiagnosisRun& found, const NoiseModel& noise, const Projector& projector,
                const Eigen::MatrixXd& y, const Eigen::VectorXd& before) {
  const Eigen::MatrixXd left = noise.Whiten(found.run, Eigen::MatrixXd(before));
  Powers powers;
  double sum = 0.0, most = 0.0;
  for (const Accepted& term : found.accepted) {
    const Eigen::MatrixXd signature = term.columns * term.amplitudes;
    powers.explained.push_back(noise.Whiten(found.run, signature).col(0).dot(left.col(0)));
    sum += powers.explained.back();
    most = std::max(most, powers.explained.back());  // where another takes some of it back
  }
  powers.removable = std::max({y.col(0).dot(left.col(0)) - projector.DegreesOfFreedom(), sum, most});
  return powers;
}

/// Two orders of one effect stand in the same order in both lists.
std::vector<double> SharesOfCauses(const DiagnosisRun& found, const Powers& powers) {
  std::vector<double> shares;
  std::set<std::size_t> used;
  for (const Cause& cause : found.diagnosis.causes) {
    shares.push_back(kNaN);
    for (std::size_t k = 0; k < found.accepted.size(); ++k) {
      const Family& family = found.accepted[k].family;
      if (family.kind != Kind::kNamed || family.effect != cause.effect || family.where != cause.where) continue;
      if (!used.insert(k).second) continue;
      shares.back() = powers.explained[k] / powers.removable;
      break;
    }
  }
  return shares;
}

double ShareUnnamed(const DiagnosisRun& found, const Powers& powers) {
  double sum = kNaN;
  for (std::size_t k = 0; k < found.accepted.size(); ++k) {
    if (found.accepted[k].family.kind != Kind::kUnknown) continue;
    sum = (std::isfinite(sum) ? sum : 0.0) + powers.explained[k] / powers.removable;
  }
  return sum;
}

int LoudestChannel(const LinearRun& run, const Eigen::VectorXd& before) {
  Eigen::VectorXd power = Eigen::VectorXd::Zero(run.Channels());
  for (int k = 0; k < run.Rows(); ++k) power[run.ChannelOf(k)] += std::pow(before[k] / run.sigma[k], 2);
  int loudest = 0;
  power.maxCoeff(&loudest);
  return loudest;
}

/// Readings of the measurement itself, or all where there are no others.
std::vector<int> ReadingsOf(const Schedule& s) {
  std::vector<int> measured, all;
  for (int i = 0; i < s.Readings(); ++i) {
    all.push_back(i);
    if (s.phase[At(i)] == Phase::kFullCircle) measured.push_back(i);
  }
  return measured.empty() ? all : measured;
}

/// Within one turn where there are several; angles that lie within one stay as they were recorded.
Eigen::VectorXd InOneTurn(const Eigen::VectorXd& x_deg) {
  constexpr double kTurn_deg = 360.0, kSame_deg = 1e-6;
  const auto finite = [](double x) { return std::isfinite(x); };
  const double lowest = x_deg.unaryExpr([&](double x) { return finite(x) ? x : 1e300; }).minCoeff();
  const double highest = x_deg.unaryExpr([&](double x) { return finite(x) ? x : -1e300; }).maxCoeff();
  if (highest - lowest <= kTurn_deg + kSame_deg) return x_deg;
  return InTurn_deg(x_deg);
}

/// What the angles of the course are told in: those of a linear axis, which is compared with its one channel, as lengths.
ChannelUnit UnitAlong(const LinearRun& run) {
  const ChannelUnit shown = run.UnitOf(0);
  const bool is_angle = shown.name == "deg" || shown.name == "arcsec";
  const BenchFormat* const bench = FindFormat(run.bench);
  return bench && bench->compared && run.Channels() == 1 && !is_angle ? shown : ChannelUnit{"deg", units::deg};
}

/// Where each reading stood: the first angle of the course that is there, else its number.
Eigen::VectorXd Along(const LinearRun& run, ErrorCurve& curve) {
  const Schedule& s = run.schedule;
  const ChannelUnit unit = UnitAlong(run);
  for (const Eigen::VectorXd* angle_rad : {&s.target_rad, &s.reference_rad}) {
    if (angle_rad->size() != s.Readings() || !angle_rad->array().isFinite().any()) continue;
    curve.along_unit = unit.name;
    const bool is_angle = unit.name == "deg";
    curve.along = is_angle ? "angle" : "position";
    const Eigen::VectorXd x = *angle_rad / unit.to_SI;
    return is_angle ? InOneTurn(x) : x;
  }
  curve.along = "reading";
  Eigen::VectorXd number(s.Readings());
  for (int i = 0; i < s.Readings(); ++i) number[i] = s.reading[At(i)];
  return number;
}

struct Mean {
  double sum = 0.0;
  int n = 0;
};

std::vector<double> ValuesOf(const std::vector<Mean>& means, double unit_SI) {
  std::vector<double> values;
  for (const Mean& mean : means) values.push_back(mean.n > 0 ? mean.sum / mean.n / unit_SI : kNaN);
  return values;
}

double LargestOf(const std::array<std::vector<Mean>, 2>& means) {
  double largest = 0.0;
  for (const std::vector<Mean>& direction : means) {
    for (const Mean& mean : direction) largest = std::max(largest, mean.n > 0 ? std::abs(mean.sum / mean.n) : 0.0);
  }
  return largest;
}

ErrorCurve CurveOf(const LinearRun& run, const Eigen::VectorXd& before) {
  ErrorCurve curve;
  const Schedule& s = run.schedule;
  const int channel = LoudestChannel(run, before);
  curve.channel = run.channels[At(channel)];
  const std::vector<int> readings = ReadingsOf(s);
  curve.is_directed = std::ranges::any_of(readings, [&s](int i) { return s.direction[At(i)] != 0; });
  const Eigen::VectorXd x = Along(run, curve)(readings);
  const Bins places = MakeBins(x, At(kCurvePlaces), kCurvePlaces);
  std::array<std::vector<Mean>, 2> means;
  for (std::vector<Mean>& direction : means) direction.resize(places.centre.size());
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const int direction = s.direction[At(readings[k])], place = places.of_value[k];
    if (place < 0 || (curve.is_directed && direction == 0)) continue;
    Mean& mean = means[direction < 0 ? 1 : 0][At(place)];
    mean.sum += before[readings[k] * run.Channels() + channel];
    ++mean.n;
  }
  const ChannelUnit unit = FinerUnit(run.UnitOf(channel), LargestOf(means));
  curve.unit = unit.name;
  curve.x = places.centre;
  curve.forward = ValuesOf(means[0], unit.to_SI);
  curve.backward = ValuesOf(means[1], unit.to_SI);
  return curve;
}

}  // namespace

Shown ShownBy(const DiagnosisRun& found) {
  const NoiseModel noise{found.noise.sigma, {}};
  const Projector projector(noise.Whiten(found.run, found.run.nuisance.jacobian), found.run.nuisance);
  const Eigen::MatrixXd y = noise.Whiten(found.run, Eigen::MatrixXd(found.run.residual));
  const Eigen::VectorXd before = found.run.residual - found.run.nuisance.jacobian * projector.Solve(y).col(0);
  const Powers powers = PowersOf(found, noise, projector, y, before);
  return {SharesOfCauses(found, powers), ShareUnnamed(found, powers), CurveOf(found.run, before)};
}

bool IsSignificant(const Harmonic& harmonic, std::size_t orders) {
  // The amplitude of a wave of noise is Rayleigh: beyond a with probability exp(-a^2 / 2 u^2).
  constexpr double kByChance = 0.01;
  const double ratio = harmonic.amplitude_rad / harmonic.u_amplitude_rad;
  return std::exp(-0.5 * ratio * ratio) < kByChance / static_cast<double>(std::max<std::size_t>(1, orders));
}

}  // namespace twinbench::diagnose
