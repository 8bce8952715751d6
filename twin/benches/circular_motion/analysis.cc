#include "twin/benches/circular_motion/analysis.h"

#include <algorithm>

#include "twin/core/errors.h"

namespace twinbench::benches::circular {
namespace {

using namespace separate::circular;

/// Two unknowns that are one wave: cosine * cos(order a) + sine * sin(order a). The scenario has it as
/// amplitude * cos(order (a - azimuth)), or likewise with the sine.
struct WaveKeys {
  std::string cosine, sine, amplitude, azimuth, unit;
  double order;
  bool of_sine;
  double sign = 1.0;  // -1: the scenario has a phase that is added
};

const std::vector<WaveKeys>& Waves() {
  static const std::vector<WaveKeys> waves = {
      {"machine.cyclic_x_cosine_um", "machine.cyclic_x_sine_um", "machine.cyclic_x_um",
       "machine.cyclic_phase_x_deg", "um", 1.0, true, -1.0},
      {"machine.cyclic_y_cosine_um", "machine.cyclic_y_sine_um", "machine.cyclic_y_um",
       "machine.cyclic_phase_y_deg", "um", 1.0, true, -1.0},
      {"bar.ball2_cosine_um", "bar.ball2_sine_um", "bar.ball2_um", "bar.ball2_azimuth_deg", "um", 2.0, false},
      {"bar.ball3_cosine_um", "bar.ball3_sine_um", "bar.ball3_um", "bar.ball3_azimuth_deg", "um", 3.0, false},
      {"encoder.eccentricity_cosine_arcsec", "encoder.eccentricity_sine_arcsec", "encoder.eccentricity_arcsec",
       "encoder.eccentricity_azimuth_deg", "arcsec", 1.0, true},
      {"encoder.ellipticity_cosine_arcsec", "encoder.ellipticity_sine_arcsec", "encoder.ellipticity_arcsec",
       "encoder.ellipticity_azimuth_deg", "arcsec", 2.0, true}};
  return waves;  // constant
}

Eigen::Index IndexOf(const CircleFit& fit, const std::string& key) {
  const auto found = std::ranges::find(fit.fitted, key, [](std::size_t k) { return CircleUnknowns()[k].key; });
  return found == fit.fitted.end() ? -1 : found - fit.fitted.begin();
}

double Fitted(const CircleFit& fit, Eigen::Index k) {
  CircleErrors errors = fit.errors;
  return CircleUnknowns()[fit.fitted[static_cast<std::size_t>(k)]].in(errors);
}

bool IsIdentified(const CircleFit& fit, Eigen::Index k) {
  return fit.identified[static_cast<std::size_t>(k)];
}

void AddWave(const CircleFit& fit, const WaveKeys& wave, std::vector<ErrorValue>& errors) {
  const Eigen::Index i = IndexOf(fit, wave.cosine), j = IndexOf(fit, wave.sine);
  if (i < 0 || j < 0) return;
  const double to_SI = CircleUnknowns()[fit.fitted[static_cast<std::size_t>(i)]].to_SI;
  const Eigen::Vector2d both(Fitted(fit, i), Fitted(fit, j));
  const std::vector<Eigen::Index> at = {i, j};
  const Eigen::Matrix2d cov = fit.shared.cov(at, at);
  const double amplitude = both.norm();
  const Eigen::Vector2d along = both / amplitude, across(-along.y(), along.x());
  const double angle_rad = wave.of_sine ? std::atan2(-both.x(), both.y()) : std::atan2(both.y(), both.x());
  const bool known = IsIdentified(fit, i) && IsIdentified(fit, j);
  errors.push_back(
      {wave.amplitude, wave.unit, amplitude / to_SI, known ? std::sqrt(along.dot(cov * along)) / to_SI : kNaN});
  errors.push_back({wave.azimuth, "deg", wave.sign * angle_rad / wave.order / units::deg,
                    known ? std::sqrt(across.dot(cov * across)) / amplitude / wave.order / units::deg : kNaN});
}

bool IsOfWave(const std::string& key) {
  return std::ranges::any_of(Waves(), [&](const WaveKeys& w) { return w.cosine == key || w.sine == key; });
}

void Fit(const Scenario& scenario, CircleAnalysis& a) {
  const CircleConstants known = ConstantsOf(CircularOf(scenario));
  a.fit = FitCircles(a.points, known);
  a.paths = RigorousPaths(a.points, a.fit, known);
}

}  // namespace

CircleAnalysis Analyse(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator) {
  CircleAnalysis a;
  a.points = PointsOf(readings, scenario);
  if (a.points.empty()) throw InputError("readings", "none has radius and angle", "readings of a bar or a grid");
  if (estimator == Estimator::kRigorous)
    Fit(scenario, a);
  else
    a.paths = PublishedPaths(a.points);
  a.deviations = CircularDeviations(a.paths, a.fit.shared);
  for (const CirclePoint& p : a.points) {
    if (p.is_bar && !a.published_offset_m.contains(p.setup))
      a.published_offset_m[p.setup] = PublishedOffsetOf_m(a.points, p.setup);
  }
  return a;
}

std::vector<ErrorValue> ErrorsOf(const CircleFit& fit) {
  std::vector<ErrorValue> errors;
  for (std::size_t k = 0; k < fit.fitted.size(); ++k) {
    const CircleUnknown& unknown = CircleUnknowns()[fit.fitted[k]];
    if (IsOfWave(unknown.key)) continue;
    const auto at = static_cast<Eigen::Index>(k);
    errors.push_back({unknown.key, unknown.unit, Fitted(fit, at) / unknown.to_SI,
                      IsIdentified(fit, at) ? std::sqrt(fit.shared.cov(at, at)) / unknown.to_SI : kNaN});
  }
  for (const WaveKeys& wave : Waves()) AddWave(fit, wave, errors);
  return errors;
}

}  // namespace twinbench::benches::circular
