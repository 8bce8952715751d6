#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "twin/core/effect_catalogue.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/rotary/families.h"
#include "twin/diagnose/rotary/signals.h"

namespace twinbench::diagnose::rotary {
namespace {

using units::arcsec;
using units::mrad;
using units::um;

/// What is plausible before checking (knowledge of such benches), and what is physically possible at all.
struct Plausible {
  double sd, lower, upper;
};
Plausible PlausibleOf(const std::string& effect, const std::string& parameter) {
  const auto both = [](double sd, double limit) { return Plausible{sd, -limit, limit}; };
  if (effect == "psd_gain") return both(0.005, 0.2);
  if (effect == "psd_roll") return both(6 * mrad, 150 * mrad);
  if (effect == "psd_nonlinearity") return both(2e5, 5e6);
  if (effect == "stray_light") return {0.006, 0.0, 0.3};
  if (effect == "psd_distance") return both(0.7e-3, 20e-3);
  if (effect == "wavelength_offset") return both(4e-9, 40e-9);
  if (effect == "wavelength_temperature") return both(0.05e-9, 1e-9);
  if (effect == "incidence_offset") return both(6 * mrad, 100 * mrad);
  if (effect == "laser_drift") return both(20e-6 / units::hour, 1e-3 / units::hour);
  if (effect == "mount_creep") return both(2 * arcsec, 200 * arcsec);
  if (effect == "thermal_tilt") return both(5 * arcsec, 200 * arcsec);
  if (effect == "backlash") return {1 * arcsec, 0.0, 300 * arcsec};
  if (effect == "settling") return both(5 * arcsec, 300 * arcsec);
  if (effect == "bearing_half_frequency") return both(1 * arcsec, 30 * arcsec);
  if (effect == "slip") return parameter == "shift" ? both(4 * um, 500 * um) : both(3 * arcsec, 500 * arcsec);
  if (effect == "adc_step") return both(4e-3, 0.3);
  if (effect == "crosstalk") return both(0.01, 0.3);
  if (effect == "tone") return both(0.5 * um, 100 * um);
  Require(false, "no plausible size is known for an effect");
  return {};
}

Amplitude AmplitudeOf(const std::string& effect, const std::string& parameter) {
  const EffectEntry* entry = FindEffect(effect);
  for (const EffectParameter& p : entry->parameters) {
    if (p.name != parameter) continue;
    const Plausible plausible = PlausibleOf(effect, parameter);
    return {parameter, p.unit, p.to_SI, plausible.sd, plausible.lower, plausible.upper};
  }
  Require(false, "an effect lacks a parameter of the catalogue");
  return {};
}

Shape ShapeOf(const std::string& effect, const std::string& parameter, std::vector<double> values) {
  const EffectEntry* entry = FindEffect(effect);
  for (const EffectParameter& p : entry->parameters) {
    if (p.name != parameter) continue;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double lower = *low, upper = *high;
    return {parameter, p.unit, p.to_SI, lower, upper, std::move(values)};
  }
  Require(false, "an effect lacks a parameter of the catalogue");
  return {};
}

/// From `lower` to `upper`, evenly in the logarithm.
std::vector<double> Logarithmic(double lower, double upper, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(lower * std::pow(upper / lower, k / (count - 1.0)));
  return values;
}

std::vector<double> Even(double lower, double upper, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(lower + (upper - lower) * k / (count - 1.0));
  return values;
}

Family Named(const std::string& effect, const std::string& where, std::vector<Amplitude> amplitudes) {
  Family family;
  family.effect = family.group = effect;
  family.where = where;
  family.amplitudes = std::move(amplitudes);
  return family;
}

/// How the readings change with one property of the bench, by central differences.
Eigen::VectorXd BenchColumn(const RotaryRun& rotary, const std::string& effect, const std::string& where,
                            const Parameters& step, double reference_degC) {
  const Eigen::VectorXd above_K = LaggedTemperature(rotary.run.schedule, reference_degC, 0.0);
  Parameters back = step;
  for (auto& parameter : back) parameter.second = -parameter.second;
  Eigen::VectorXd column(rotary.run.Rows());
  for (std::size_t i = 0; i < rotary.motion.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    OpticalBench more = rotary.bench, less = rotary.bench;
    AlterBench(effect, where, step, above_K[at], more);
    AlterBench(effect, where, back, above_K[at], less);
    column.segment<4>(4 * at) = (ShownSpots(more, rotary.motion[i]) - ShownSpots(less, rotary.motion[i])) / 2.0;
  }
  return column;
}

Family BenchFamily(const std::string& effect, const std::string& where, const std::string& parameter,
                   const RotaryRun& rotary, double reference_degC) {
  Family family = Named(effect, where, {AmplitudeOf(effect, parameter)});
  const double step = 0.01 * family.amplitudes[0].prior_sd;
  const Eigen::MatrixXd column = BenchColumn(rotary, effect, where, {{parameter, step}}, reference_degC) / step;
  family.columns = [column](int) { return column; };
  return family;
}

/// Spots from their mean in each set-up and phase: as the PSD sees them if it is centred anew after every mounting.
Eigen::VectorXd CentredSpots(const RotaryRun& rotary) {
  Eigen::VectorXd spots = rotary.run.Predicted();
  const Schedule& s = rotary.run.schedule;
  std::map<std::pair<Phase, int>, std::pair<Eigen::Vector4d, int>> sums;
  for (std::size_t i = 0; i < s.reading.size(); ++i) {
    auto& sum = sums.try_emplace({s.phase[i], s.setup[i]}, Eigen::Vector4d::Zero(), 0).first->second;
    sum.first += spots.segment<4>(4 * static_cast<Eigen::Index>(i));
    ++sum.second;
  }
  for (std::size_t i = 0; i < s.reading.size(); ++i) {
    const auto& sum = sums.at({s.phase[i], s.setup[i]});
    spots.segment<4>(4 * static_cast<Eigen::Index>(i)) -= sum.first / sum.second;
  }
  return spots;
}

/// u r^2 and u r^4 of one PSD.
Eigen::MatrixXd PincushionColumns(const Eigen::VectorXd& spots_m, int psd) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(spots_m.size(), 2);
  for (Eigen::Index k = 2 * psd; k < spots_m.size(); k += kChannels) {
    const double r2_m2 = spots_m.segment<2>(k).squaredNorm();
    columns.block<2, 1>(k, 0) = r2_m2 * spots_m.segment<2>(k);
    columns.block<2, 1>(k, 1) = r2_m2 * columns.block<2, 1>(k, 0);
  }
  return columns;
}

/// Electrodes bend higher orders as well: r^4 comes along with r^2, a fifth of it at a typical spot.
void AddNonlinearities(const RotaryRun& rotary, std::vector<Family>& families) {
  constexpr double kTypicalSpot_m = 0.4e-3;
  const Amplitude cubic = AmplitudeOf("psd_nonlinearity", "cubic");
  const Amplitude quintic = {"quintic", "per_m4", 1.0, 0.2 * cubic.prior_sd / (kTypicalSpot_m * kTypicalSpot_m)};
  for (int psd = 0; psd < 2; ++psd) {
    for (const Eigen::VectorXd& spots_m : {rotary.run.Predicted(), CentredSpots(rotary)}) {
      Family family = Named("psd_nonlinearity", psd == 0 ? "psd_a" : "psd_b", {cubic, quintic});
      const Eigen::MatrixXd columns = PincushionColumns(spots_m, psd);
      family.columns = [columns](int) { return columns; };
      families.push_back(std::move(family));
    }
  }
}

void AddBenchFamilies(const RotaryRun& rotary, const Scenario& scenario, std::vector<Family>& families) {
  const std::array<std::array<const char*, 2>, 7> causes = {{{"psd_gain", "gain_error"},
                                                             {"psd_roll", "roll"},
                                                             {"stray_light", "fraction"},
                                                             {"psd_distance", "distance_error"},
                                                             {"wavelength_offset", "wavelength_error"},
                                                             {"wavelength_temperature", "wavelength_per_kelvin"},
                                                             {"incidence_offset", "incidence"}}};
  for (const auto& [effect, parameter] : causes) {
    std::vector<std::string> places = FindEffect(effect)->places;
    if (places.empty()) places = {""};
    for (const std::string& where : places) {
      families.push_back(BenchFamily(effect, where, parameter, rotary, scenario.environment.reference_degC));
    }
  }
  AddNonlinearities(rotary, families);
}

void SetSignal(Family& family, const std::function<Eigen::MatrixXd(const Eigen::VectorXd&)>& at) {
  std::vector<Eigen::VectorXd> grid;
  for (int g = 0; g < family.grid; ++g) grid.push_back(family.ShapeAt(g));
  family.columns = [at, grid](int g) { return at(grid[static_cast<std::size_t>(g)]); };
  family.at = at;
}

/// An additive effect whose shape is one parameter on a grid.
Family SignalFamily(const std::string& effect, const std::string& where, std::vector<Amplitude> amplitudes,
                    std::vector<Shape> shapes, const SignalContext& context) {
  Family family = Named(effect, where, std::move(amplitudes));
  family.shapes = std::move(shapes);
  family.grid = family.shapes.empty() ? 1 : static_cast<int>(std::ssize(family.shapes[0].value));
  std::vector<std::string> names;
  for (const Shape& s : family.shapes) names.push_back(s.name);
  SetSignal(family, [effect, where, names, &context](const Eigen::VectorXd& shape) {
    Parameters parameters;
    for (std::size_t k = 0; k < names.size(); ++k) parameters[names[k]] = shape[static_cast<Eigen::Index>(k)];
    return EffectSignal(effect, where, parameters, context);
  });
  return family;
}

/// Amplitude and phase of a pair of columns (amplitude x cos, amplitude x sin of the phase).
ParameterEstimate LengthOf(const Amplitude& a, const Eigen::Vector2d& pair, const Eigen::Matrix2d& cov) {
  const double length = pair.norm();
  const Eigen::Vector2d along = length > 0.0 ? Eigen::Vector2d(pair / length) : Eigen::Vector2d(1.0, 0.0);
  return {a.name, a.unit, a.to_SI, length, std::sqrt(along.dot(cov * along)), 0.0, a.upper};
}

ParameterEstimate Plain(const Shape& shape, double value) {
  return {shape.name, shape.unit, shape.to_SI, value, kNaN, shape.lower, shape.upper};
}

void AddTimeFamilies(const SignalContext& context, const Schedule& s, std::vector<Family>& families) {
  for (const char* where : {"yaw", "pitch"}) {
    families.push_back(SignalFamily("laser_drift", where, {AmplitudeOf("laser_drift", "drift")},
                                    {ShapeOf("laser_drift", "curvature", Even(-1.0, 1.0, 9))}, context));
  }
  for (const char* where : {"yaw", "tilt"}) {
    for (const bool calibration_too : {true, false}) {
      Family creep = SignalFamily("mount_creep", where, {AmplitudeOf("mount_creep", "amplitude")},
                                  {ShapeOf("mount_creep", "time_constant", Logarithmic(5.0, 1500.0, 7))}, context);
      SetSignal(creep, [&context, calibration_too, where](const Eigen::VectorXd& shape) {
        return OnChannels(CreepSignal(context.run.schedule, shape[0], calibration_too),
                          WeightOf(where, context.shown_by_motion));
      });
      families.push_back(std::move(creep));
    }
    if (!s.temperature_degC.array().isFinite().any()) continue;
    families.push_back(SignalFamily("thermal_tilt", where, {AmplitudeOf("thermal_tilt", "tilt_per_kelvin")},
                                    {ShapeOf("thermal_tilt", "lag", {0.0, 150.0, 300.0, 600.0, 900.0, 1350.0, 2000.0, 3000.0})},
                                    context));
  }
}

Family HalfFrequency(const SignalContext& context, const Whirling& whirling) {
  const Amplitude tilt = AmplitudeOf("bearing_half_frequency", "tilt");
  Family half = SignalFamily("bearing_half_frequency", "", {tilt, tilt},
                             {ShapeOf("bearing_half_frequency", "order", Even(0.35, 0.65, 61))}, context);
  SetSignal(half, [&context, whirling](const Eigen::VectorXd& shape) {
    return HalfFrequencySignal(shape[0], whirling, context);
  });
  half.parameters = [a = half.amplitudes[0], o = half.shapes[0]](const Eigen::VectorXd& shape, const Eigen::VectorXd& x,
                                                                const Eigen::MatrixXd& cov) {
    return std::vector<ParameterEstimate>{Plain(o, shape[0]), LengthOf(a, x, cov)};
  };
  return half;
}

void AddTravelFamilies(const SignalContext& context, const Schedule& s, std::vector<Family>& families) {
  for (const char* where : {"target", "reference"}) {
    families.push_back(SignalFamily("backlash", where, {AmplitudeOf("backlash", "half_width")}, {}, context));
  }
  if (s.dwell_s.array().isFinite().any()) {
    families.push_back(SignalFamily("settling", "", {AmplitudeOf("settling", "amplitude")},
                                    {ShapeOf("settling", "time_constant", Logarithmic(0.3, 4.0, 8))}, context));
  }
  for (const Turning turning : {Turning::kContinued, Turning::kThroughSetups, Turning::kTravelled}) {
    for (const double lever_m : {context.target_height_m, 0.0}) {
      for (const double sense : {1.0, -1.0}) families.push_back(HalfFrequency(context, {turning, lever_m, sense}));
    }
  }
}

/// Levels at which a step would part the readings of a channel, as finely as they lie.
std::vector<double> StepLevels_V(const SignalContext& context, int channel) {
  constexpr int kLevels = 160;
  Eigen::VectorXd volts = Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<>>(
      context.shown_m.data() + channel, context.run.schedule.Readings(), Eigen::InnerStride<>(kChannels));
  volts *= context.sensitivity_V_m[static_cast<std::size_t>(channel / 2)];
  std::sort(volts.begin(), volts.end());
  std::vector<double> levels = {0.0};
  for (int k = 1; k < kLevels; ++k) levels.push_back(volts[k * (volts.size() - 1) / kLevels]);
  return levels;
}

/// @param blur_V  Width of the step in block means: the noise of a sample, or nearly nothing if the means jump.
Family StepFamily(const SignalContext& context, int channel, double blur_V) {
  const std::string where = kChannelNames[static_cast<std::size_t>(channel)];
  Family family = SignalFamily("adc_step", where, {AmplitudeOf("adc_step", "step")},
                               {ShapeOf("adc_step", "at_voltage", StepLevels_V(context, channel))}, context);
  SetSignal(family, [&context, channel, blur_V](const Eigen::VectorXd& shape) {
    return AdcStepSignal(channel, shape[0], blur_V, context);
  });
  return family;
}

void AddElectronicFamilies(const SignalContext& context, std::vector<Family>& families) {
  constexpr double kSharp_V = 0.2e-3;
  for (int c = 0; c < kChannels; ++c) {
    const std::string where = kChannelNames[static_cast<std::size_t>(c)];
    families.push_back(SignalFamily("crosstalk", where, {AmplitudeOf("crosstalk", "fraction")}, {}, context));
    for (const double blur_V : {std::max(kSharp_V, context.sample_noise_V), kSharp_V}) {
      families.push_back(StepFamily(context, c, blur_V));
    }
  }
}

/// A tone with an amplitude and a phase of its own on every channel.
Family FreeTone(const RotaryRun& rotary, const SharedSeries& series) {
  const Amplitude amplitude = AmplitudeOf("tone", "amplitude");
  Family family = Named("tone", "all", std::vector<Amplitude>(2 * kChannels, amplitude));
  family.shapes = {ShapeOf("tone", "frequency", series.frequency_Hz)};
  family.grid = series.tone->grid;
  family.base = series.tone;
  family.map = Eigen::MatrixXd::Identity(2 * kChannels, 2 * kChannels);
  family.at = [&rotary](const Eigen::VectorXd& shape) {
    return OnEachChannel(ToneSignal(rotary.run.schedule, shape[0]), kChannels);
  };
  family.parameters = [amplitude, f = family.shapes[0]](const Eigen::VectorXd& shape, const Eigen::VectorXd& x,
                                                        const Eigen::MatrixXd& cov) {
    const double rms = x.norm() / std::sqrt(static_cast<double>(kChannels)), u = std::sqrt(cov.trace() / (2.0 * kChannels));
    return std::vector<ParameterEstimate>{Plain(f, shape[0]), {"amplitude", "um", um, rms, u, 0.0, amplitude.upper}};
  };
  return family;
}

void AddTones(const RotaryRun& rotary, const SharedSeries& series, std::vector<Family>& families) {
  const auto add = [&](const std::string& where, const Eigen::Vector4d& weight) {
    const Amplitude amplitude = AmplitudeOf("tone", "amplitude");
    Family family = Named("tone", where, {amplitude, amplitude});
    family.shapes = {ShapeOf("tone", "frequency", series.frequency_Hz)};
    family.grid = series.tone->grid;
    family.base = series.tone;
    family.map = PatternMap(weight, 2);
    family.at = [&rotary, weight](const Eigen::VectorXd& shape) {
      return OnChannels(ToneSignal(rotary.run.schedule, shape[0]), weight);
    };
    family.parameters = [amplitude, f = family.shapes[0]](const Eigen::VectorXd& shape, const Eigen::VectorXd& x,
                                                          const Eigen::MatrixXd& cov) {
      return std::vector<ParameterEstimate>{
          Plain(f, shape[0]), LengthOf(amplitude, x, cov), {"phase", "deg", units::deg, std::atan2(x[1], x[0]), kNaN, kNaN, kNaN}};
    };
    families.push_back(std::move(family));
  };
  for (int c = 0; c < kChannels; ++c) add(kChannelNames[static_cast<std::size_t>(c)], Eigen::Vector4d::Unit(c));
  add("yaw", {1.0, 0.0, 1.0, 0.0});
  add("tilt", {0.0, 1.0, 0.0, 1.0});
  add("all", Eigen::Vector4d::Ones());
  families.push_back(FreeTone(rotary, series));
}

void AddSlips(const RotaryRun& rotary, const SharedSeries& series, std::vector<Family>& families) {
  for (const char* where : {"yaw", "tilt", "lateral"}) {
    const bool lateral = std::string(where) == "lateral";
    Family family = Named("slip", where, {AmplitudeOf("slip", lateral ? "shift" : "angle")});
    family.shapes = {ShapeOf("slip", "at_reading", {series.onset.begin(), series.onset.end()})};
    family.grid = series.step->grid;
    family.base = series.step;
    family.map = PatternMap(WeightOf(where, rotary.shown_by_motion), 1);
    families.push_back(std::move(family));
  }
}

/// About two grid points within the width of a line, up to the frequency of the readings.
std::vector<double> ToneGrid(const Schedule& s) {
  constexpr int kMostFrequencies = 1200;
  const double duration_s = s.time_s.maxCoeff() - s.time_s.minCoeff();
  std::vector<double> steps_s;
  for (Eigen::Index i = 1; i < s.time_s.size(); ++i) steps_s.push_back(s.time_s[i] - s.time_s[i - 1]);
  std::nth_element(steps_s.begin(), steps_s.begin() + std::ssize(steps_s) / 2, steps_s.end());
  const double usual_s = steps_s[steps_s.size() / 2];
  const double width_Hz = 0.6 / duration_s, top_Hz = 0.5 / usual_s;
  const int count = std::clamp(static_cast<int>(top_Hz / width_Hz), 1, kMostFrequencies);
  return Even(3.0 * width_Hz, std::max(top_Hz, 4.0 * width_Hz), std::max(2, count));
}

}  // namespace

SharedSeries MakeSharedSeries(const RotaryRun& rotary) {
  const Schedule& s = rotary.run.schedule;
  SharedSeries series;
  series.frequency_Hz = ToneGrid(s);
  // Within a set-up only: a step at its first reading is a constant.
  for (std::size_t i = 1; i < s.reading.size(); ++i) {
    if (s.setup[i] == s.setup[i - 1] && s.phase[i] == s.phase[i - 1]) series.onset.push_back(s.reading[i]);
  }
  constexpr std::size_t kMostOnsets = 1000;
  if (series.onset.size() > kMostOnsets) {
    std::vector<int> thinned;
    for (std::size_t k = 0; k < kMostOnsets; ++k) thinned.push_back(series.onset[k * series.onset.size() / kMostOnsets]);
    series.onset = thinned;
  }
  auto tone = std::make_shared<Base>();
  tone->grid = static_cast<int>(std::ssize(series.frequency_Hz));
  tone->columns = [&s, f = series.frequency_Hz](int g) {
    return OnEachChannel(ToneSignal(s, f[static_cast<std::size_t>(g)]), kChannels);
  };
  series.tone = tone;
  auto step = std::make_shared<Base>();
  step->grid = static_cast<int>(std::ssize(series.onset));
  step->columns = [&s, onset = series.onset](int g) {
    return OnEachChannel(StepSignal(s, onset[static_cast<std::size_t>(g)]), kChannels);
  };
  series.step = step;
  return series;
}

Eigen::MatrixXd PatternMap(const Eigen::VectorXd& weight, int signals) {
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(weight.size() * signals, signals);
  for (Eigen::Index c = 0; c < weight.size(); ++c) {
    map.middleRows(c * signals, signals) = weight[c] * Eigen::MatrixXd::Identity(signals, signals);
  }
  return map;
}

std::vector<Place> PlacesOf(const Eigen::Matrix4d& shown_by_motion) {
  std::vector<Place> places;
  for (const char* name : {"yaw", "tilt", "roll", "lateral"}) {
    const Eigen::Vector4d weight = WeightOf(name, shown_by_motion);
    places.push_back({name, weight / weight.cwiseAbs().maxCoeff()});
  }
  for (int c = 0; c < kChannels; ++c) {
    places.push_back({kChannelNames[static_cast<std::size_t>(c)], Eigen::Vector4d::Unit(c)});
  }
  return places;
}

std::vector<Family> NamedFamilies(const RotaryRun& rotary, const SignalContext& context, const Scenario& scenario,
                                  const SharedSeries& series) {
  std::vector<Family> families;
  AddBenchFamilies(rotary, scenario, families);
  AddTimeFamilies(context, rotary.run.schedule, families);
  AddTravelFamilies(context, rotary.run.schedule, families);
  AddElectronicFamilies(context, families);
  AddTones(rotary, series, families);
  AddSlips(rotary, series, families);
  return families;
}

namespace {

/// What a wrong sensitivity to one motion adds: the motion itself, as it shows.
Eigen::VectorXd SensitivityColumn(const RotaryRun& rotary, int dof) {
  Eigen::VectorXd column(rotary.run.Rows());
  for (std::size_t i = 0; i < rotary.motion.size(); ++i) {
    column.segment<4>(4 * static_cast<Eigen::Index>(i)) = rotary.shown_by_motion.col(dof) * rotary.motion[i][dof];
  }
  return column;
}

}  // namespace

std::vector<Family> ModelFamilies(const RotaryRun& rotary) {
  Eigen::MatrixXd both(rotary.run.Rows(), 2);
  both << SensitivityColumn(rotary, 0), SensitivityColumn(rotary, 1);
  const Amplitude yaw = {"yaw_scale_error", "1", 1.0, 0.1, -0.5, 0.5}, tilt = {"tilt_scale_error", "1", 1.0, 0.1, -0.5, 0.5};
  std::vector<Family> families = {Named("published_sensitivity", "yaw", {yaw}), Named("published_sensitivity", "tilt", {tilt}),
                                  Named("published_sensitivity", "yaw, tilt", {yaw, tilt})};
  families[0].columns = [both](int) { return Eigen::MatrixXd(both.leftCols(1)); };
  families[1].columns = [both](int) { return Eigen::MatrixXd(both.rightCols(1)); };
  families[2].columns = [both](int) { return both; };
  return families;
}

}  // namespace twinbench::diagnose::rotary
