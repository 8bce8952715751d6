#include "twin/benches/circular_motion/analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>

#include "twin/benches/circular_motion/estimators/found_shapes.h"
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

/// Slope and shares of the variance of an error that is made of some unknowns.
/// @param along  Its slopes by those [its unit / SI].
void SetShares(const CircleFit& fit, const std::vector<Eigen::Index>& at, const Eigen::VectorXd& along,
               ErrorValue& error) {
  error.slope = Eigen::VectorXd::Zero(fit.shared.cov.rows());
  error.slope(at) = along;
  const PartedVariance variance = fit.shared.Parted(error.slope);
  error.quantisation = variance.of_steps / variance.all;
  error.repeatability = variance.of_machine / variance.all;
  error.noise = 1.0 - error.quantisation - error.repeatability;
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
  SetShares(fit, at, along / to_SI, errors.back());
  errors.push_back({wave.azimuth, "deg", wave.sign * angle_rad / wave.order / units::deg,
                    known ? std::sqrt(across.dot(cov * across)) / amplitude / wave.order / units::deg : kNaN});
  SetShares(fit, at, wave.sign / amplitude / wave.order / units::deg * across, errors.back());
}

bool IsOfWave(const std::string& key) {
  return std::ranges::any_of(Waves(), [&](const WaveKeys& w) { return w.cosine == key || w.sine == key; });
}

/// The key in the scenario: waves are there by their amplitude.
std::string SizeKey(const std::string& unknown) {
  const auto wave = std::ranges::find_if(Waves(), [&](const WaveKeys& w) { return w.cosine == unknown || w.sine == unknown; });
  return wave == Waves().end() ? unknown : wave->amplitude;
}

double RadialRms_m(const CircleAnalysis& a, const CircleErrors& others) {
  double squares_m2 = 0.0;
  for (const CirclePoint& p : a.points) {
    const CircleMounting& mounting = a.fit.MountingOf(p.setup);
    const double of_them_m = (Shown_m(p, a.fit.errors, mounting, a.known) - Shown_m(p, others, mounting, a.known)).x();
    squares_m2 += of_them_m * of_them_m;
  }
  return std::sqrt(squares_m2 / static_cast<double>(a.points.size()));
}

bool Lags(const CircleFit& fit) {
  constexpr double kTimes_u = 3.0;
  return std::ranges::any_of(std::array{"machine.lag_x_s", "machine.lag_y_s"}, [&fit](const char* key) {
    const Eigen::Index k = IndexOf(fit, key);
    return k >= 0 && std::abs(Fitted(fit, k)) > kTimes_u * std::sqrt(fit.shared.cov(k, k));
  });
}

/// What both kinds of lag find differently is not found; the readings fit either.
void HideWhatLagDecides(const CircleFit& otherwise, CircleFit& fit) {
  std::string keys;
  for (std::size_t k = 0; k < fit.fitted.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    const CircleUnknown& unknown = CircleUnknowns()[fit.fitted[k]];
    const double one = Fitted(fit, at), other = Fitted(otherwise, at);
    if (!(std::abs(one - other) > std::sqrt(fit.shared.cov(at, at))) || unknown.key.find("lag") != std::string::npos) continue;
    fit.identified[k] = false;
    keys += fmt::format("{} is {:.4g} or {:.4g}, ", unknown.key, one / unknown.to_SI, other / unknown.to_SI);
  }
  if (!keys.empty()) fit.not_separable.push_back(keys + "by whether axes lag by first order or by a fixed time: a circle at another feed decides");
}

/// A lag of first order makes circles smaller by half the square of lag times rate, a fixed delay does not: at several feeds the
/// scales cannot take that up.
void TakeKindOfLag(CircleAnalysis& a) {
  constexpr double kClearly = 12.0;  // of chi-squared
  CircleConstants otherwise = a.known;
  otherwise.is_delay = !a.known.is_delay;
  CircleFit other = FitCircles(a.points, otherwise);
  const auto chi2 = [](const CircleFit& fit) { return static_cast<double>(fit.dof) * fit.chi * fit.chi; };
  const double left_more = (chi2(a.fit) - chi2(other)) / std::pow(std::max(1.0, std::min(a.fit.chi, other.chi)), 2);
  if (std::abs(left_more) < kClearly) {
    a.lag_kind = "ambiguous";
    return HideWhatLagDecides(other, a.fit);
  }
  if (left_more > 0.0) {
    a.known = otherwise;
    a.fit = std::move(other);
  }
  a.lag_kind = a.known.is_delay ? "fixed_delay" : "first_order";
}

/// Fits again with what the readings say of pitch and time, one after the other as each makes the other plainer.
void TakeShapes(CircleAnalysis& a) {
  constexpr int kRounds = 6;
  constexpr double kNoise = 1.3;  // times the stated one: nothing is left that a shape could explain
  if (a.fit.chi < kNoise) return;
  for (int round = 0; round < kRounds; ++round) {
    const CircleConstants as_read = WithShapeAsRead(a.points, a.fit, a.known);
    if (as_read.pitch_m == a.known.pitch_m && as_read.spike_time_s == a.known.spike_time_s) return;
    CircleFit fit = FitCircles(a.points, as_read);
    if (!(fit.chi < a.fit.chi)) return;
    a.known = as_read;
    a.fit = std::move(fit);
  }
}

void Fit(const Scenario& scenario, CircleAnalysis& a) {
  a.known = ConstantsOf(CircularOf(scenario));
  a.fit = FitCircles(a.points, a.known);
  TakeShapes(a);
  if (std::ranges::all_of(a.points, &CirclePoint::is_drive) && Lags(a.fit)) TakeKindOfLag(a);
  a.paths = RigorousPaths(a.points, a.fit, a.known);
  a.deviations = CircularDeviations(a.paths, a.fit.shared);
}

/// Squares of what two paths differ by, along the radius and across it.
PathBias BiasOf(const CirclePath& published, const CirclePath& rigorous) {
  PathBias bias{published.setup, published.pass};
  Eigen::Vector2d differ(0.0, 0.0), noise(0.0, 0.0);
  for (std::size_t i = 0; i < published.points.size(); ++i) {
    const PathPoint &p = published.points[i], &r = rigorous.points[i];
    differ += Eigen::Vector2d(p.Radial_m() - r.Radial_m(), p.Tangential_m() - r.Tangential_m()).cwiseAbs2();
    noise += r.u_own_m.cwiseAbs2();
  }
  const auto count = static_cast<double>(published.points.size());
  bias.radial_m = std::sqrt(differ.x() / count);
  bias.tangential_m = std::sqrt(differ.y() / count);
  bias.u_radial_m = std::sqrt(noise.x() / count);
  bias.u_tangential_m = std::sqrt(noise.y() / count);
  return bias;
}

/// Gives published paths the noise of their readings and what they are off by.
void ApplyBias(const std::vector<CirclePath>& rigorous, CircleAnalysis& a) {
  for (CirclePath& path : a.paths) {
    const auto same = std::ranges::find_if(
        rigorous, [&](const CirclePath& r) { return r.setup == path.setup && r.pass == path.pass; });
    const PathBias bias = BiasOf(path, *same);
    for (std::size_t i = 0; i < path.points.size(); ++i)
      path.points[i].u_own_m = {std::hypot(same->points[i].u_own_m.x(), bias.radial_m),
                                std::hypot(same->points[i].u_own_m.y(), bias.tangential_m)};
    a.method_bias.push_back(bias);
  }
}

constexpr std::array kIsoValues = {&Iso230_4::G_mz_ccw, &Iso230_4::G_mz_cw, &Iso230_4::G_mz_b,
                                  &Iso230_4::G_ccw,    &Iso230_4::G_cw,    &Iso230_4::G_b,     &Iso230_4::Fmax_ccw,
                                  &Iso230_4::Fmin_ccw, &Iso230_4::Fmax_cw, &Iso230_4::Fmin_cw, &Iso230_4::Fmax_b,
                                  &Iso230_4::Fmin_b,   &Iso230_4::D,       &Iso230_4::H};

/// A published value, which is as uncertain as the rigorous one and as wrong as both differ by.
Iso230_4Value Biased(const Iso230_4Value& rigorous, double published_m) {
  const double bias_m = published_m - rigorous.value_m, u_m = std::hypot(rigorous.u_m, bias_m);
  const double left = std::pow(rigorous.u_m / u_m, 2);
  return {published_m, u_m, left * rigorous.quantisation, left * rigorous.repeatability, 1.0 - left};
}

/// Likewise for the deviations: each is as wrong as it differs from that of the rigorous paths.
void ApplyBias(const std::vector<Iso230_4>& rigorous, std::vector<Iso230_4>& published) {
  for (Iso230_4& d : published) {
    const auto same = std::ranges::find_if(
        rigorous, [&](const Iso230_4& r) { return r.setup == d.setup && r.feed_m_s == d.feed_m_s; });
    for (const auto member : kIsoValues) (d.*member) = Biased((*same).*member, (d.*member).value_m);
  }
}

/// The published evaluation, and how far it is from the rigorous one.
void Publish(const Scenario& scenario, CircleAnalysis& a) {
  a.paths = PublishedPaths(a.points);
  a.deviations = CircularDeviations(a.paths, {});
  const CircleConstants known = ConstantsOf(CircularOf(scenario));
  CircleFit fit;
  try {
    fit = FitCircles(a.points, known);
  } catch (const InputError&) {
    return;  // too few readings: what the equations are wrong by is not known
  }
  const std::vector<CirclePath> rigorous = RigorousPaths(a.points, fit, known);
  ApplyBias(rigorous, a);
  ApplyBias(CircularDeviations(rigorous, fit.shared), a.deviations);
}

}  // namespace

CircleAnalysis Analyse(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator) {
  CircleAnalysis a;
  a.points = PointsOf(readings, scenario);
  if (a.points.empty()) throw InputError("readings", "none has a radius", "readings of a bar or a grid");
  if (estimator == Estimator::kRigorous)
    Fit(scenario, a);
  else
    Publish(scenario, a);
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
    SetShares(fit, {at}, Eigen::VectorXd::Constant(1, 1.0 / unknown.to_SI), errors.back());
  }
  for (const WaveKeys& wave : Waves()) AddWave(fit, wave, errors);
  return errors;
}

CircleErrors ErrorsWithout(const CircleFit& fit, const std::vector<std::string>& keys) {
  CircleErrors others = fit.errors;
  for (const std::size_t k : fit.fitted)
    if (std::ranges::count(keys, SizeKey(CircleUnknowns()[k].key)) > 0) CircleUnknowns()[k].in(others) = 0.0;
  return others;
}

std::vector<RadialPart> RadialPartsOf(const CircleAnalysis& a) {
  std::map<std::string, RadialPart> kinds;
  for (const std::size_t k : a.fit.fitted) {
    const std::string key = SizeKey(CircleUnknowns()[k].key);
    const std::size_t axis = std::min(key.find("_x_"), key.find("_y_"));
    std::vector<std::string>& keys = kinds[axis == key.npos ? key : std::string(key).erase(axis, 2)].keys;
    if (std::ranges::count(keys, key) == 0) keys.push_back(key);
  }
  std::vector<RadialPart> parts;
  for (auto& [kind, part] : kinds) parts.push_back({part.keys, RadialRms_m(a, ErrorsWithout(a.fit, part.keys))});
  std::ranges::stable_sort(parts, std::greater(), &RadialPart::rms_m);
  return parts;
}

double WavePart::Of(double amplitude_of_wave, double azimuth_deg) const {
  const double angle_rad = sign * order * azimuth_deg * units::deg;
  // A sin(x - angle) = -A sin(angle) cos(x) + A cos(angle) sin(x); A cos(x - angle) likewise.
  const double cosine = wave_of_sine ? -std::sin(angle_rad) : std::cos(angle_rad),
               sine = wave_of_sine ? std::cos(angle_rad) : std::sin(angle_rad);
  return amplitude_of_wave * (is_cosine ? cosine : sine);
}

std::vector<WavePart> WavePartsOf(const CircleFit& fit) {
  std::vector<WavePart> parts;
  for (const WaveKeys& wave : Waves()) {
    const Eigen::Index i = IndexOf(fit, wave.cosine), j = IndexOf(fit, wave.sine);
    if (i < 0 || j < 0 || !IsIdentified(fit, i) || !IsIdentified(fit, j)) continue;
    for (const Eigen::Index k : {i, j}) {
      const CircleUnknown& unknown = CircleUnknowns()[fit.fitted[static_cast<std::size_t>(k)]];
      parts.push_back({{unknown.key, wave.unit, Fitted(fit, k) / unknown.to_SI,
                        std::sqrt(fit.shared.cov(k, k)) / unknown.to_SI},
                       wave.amplitude, wave.azimuth, wave.order, wave.sign, wave.of_sine, k == i});
    }
  }
  return parts;
}

}  // namespace twinbench::benches::circular
