#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "twin/benches/rotary_4dof/format.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/candidates.h"
#include "twin/diagnose/rotary/families.h"
#include "twin/diagnose/rotary/signals.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::rotary {
namespace {

const char* ChannelName(int channel) {
  return kChannelNames[static_cast<std::size_t>(channel)];
}

/// A motion of the grating, by what the channels show of it.
Showing Moved(const std::string& effect, const std::string& where, const SignalContext& c, double factor = 1.0) {
  return {effect, where, factor * WeightOf(where.empty() ? "yaw" : where, c.shown_by_motion)};
}

/// A cause whose signature is rows already.
Showing InRows(const std::string& effect, const std::string& where) {
  return {effect, where, {}};
}

/// How the readings change with one property of the bench as it is believed, by central differences.
Eigen::VectorXd BenchColumn(const RotaryRun& rotary, const Scenario& scenario, const std::string& effect,
                            const std::string& where, const std::string& parameter, double step) {
  const Eigen::VectorXd above_K = model::Above_K(rotary.run.schedule, scenario.environment.reference_degC);
  Eigen::VectorXd column(rotary.run.Rows());
  for (std::size_t i = 0; i < rotary.motion.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    OpticalBench more = WithKnownEffects(rotary.bench, scenario, above_K[at]), less = more;
    AlterBench(effect, where, {{parameter, step}}, above_K[at], more);
    AlterBench(effect, where, {{parameter, -step}}, above_K[at], less);
    column.segment<4>(4 * at) =
        (ShownSpots(more, rotary.motion[i]) - ShownSpots(less, rotary.motion[i])) / (2.0 * step);
  }
  return column;
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

/// Spots from their mean in each set-up and phase: as the PSD sees them if it is centred anew after every mounting.
Eigen::VectorXd CentredSpots(const RotaryRun& rotary) {
  const Schedule& s = rotary.run.schedule;
  std::vector<int> mounting;
  for (std::size_t i = 0; i < s.reading.size(); ++i)
    mounting.push_back(2 * s.setup[i] + (s.phase[i] == Phase::kCalibration ? 1 : 0));
  const Eigen::MatrixXd which = model::Indicators(mounting);
  const Eigen::VectorXd spots = rotary.run.Predicted(), count = which.colwise().sum();
  Eigen::VectorXd centred = spots;
  for (int c = 0; c < kChannels; ++c) {
    const Eigen::VectorXd of_channel = spots(Eigen::seq(c, Eigen::last, kChannels));
    const Eigen::VectorXd mean = (which.transpose() * of_channel).cwiseQuotient(count);
    centred(Eigen::seq(c, Eigen::last, kChannels)) -= which * mean;
  }
  return centred;
}

/// Electrodes bend higher orders as well: r^4 comes along with r^2, a fifth of it at a typical spot.
void AddNonlinearities(const RotaryRun& rotary, Candidates& named) {
  constexpr double kTypicalSpot_m = 0.4e-3;
  for (int psd = 0; psd < 2; ++psd) {
    for (const Eigen::VectorXd& spots_m : {rotary.run.Predicted(), CentredSpots(rotary)}) {
      Family& family = named.Add(InRows("psd_nonlinearity", psd == 0 ? "psd_a" : "psd_b"), {"cubic", "cubic"},
                                 PincushionColumns(spots_m, psd));
      const double cubic_per_m2 = family.amplitudes[0].prior_sd;
      family.amplitudes[1] = {"quintic", "per_m4", 1.0, 0.2 * cubic_per_m2 / (kTypicalSpot_m * kTypicalSpot_m)};
    }
  }
}

/// Causes that are a wrong property of the bench.
void AddBench(const RotaryRun& rotary, const Scenario& scenario, Candidates& named) {
  constexpr double kStep = 0.01;  // of a plausible size
  const std::array<std::array<const char*, 2>, 8> causes = {{{"psd_gain", "gain_error"},
                                                             {"psd_roll", "roll"},
                                                             {"stray_light", "fraction"},
                                                             {"psd_distance", "distance_error"},
                                                             {"wavelength_offset", "wavelength_error"},
                                                             {"grating_pitch", "pitch_error"},
                                                             {"wavelength_temperature", "wavelength_per_kelvin"},
                                                             {"incidence_offset", "incidence"}}};
  for (const auto& [effect, parameter] : causes) {
    std::vector<std::string> places = FindEffect(effect, scenario.bench)->places;
    if (places.empty()) places = {""};
    const double step = kStep * named.catalogue().AmplitudeOf(effect, parameter).prior_sd;
    for (const std::string& where : places)
      named.Add(InRows(effect, where), {parameter}, BenchColumn(rotary, scenario, effect, where, parameter, step));
  }
  AddNonlinearities(rotary, named);
}

/// The grating sat on a mounting of its own in the calibration, which may have crept otherwise, or not at all.
void AddCreep(const SignalContext& c, const Schedule& s, const char* where, Candidates& named) {
  Family& family = named.AddOver(
      Moved("mount_creep", where, c), {"amplitude", "amplitude"},
      {named.catalogue().ShapeOf("mount_creep", "time_constant", Ratios(5.0, 1500.0, 7))},
      [since_s = model::SinceFirst_s(s), moved = InCircle(s)](const Eigen::VectorXd& tau_s) {
        const Eigen::ArrayXd creep = (since_s.array() / tau_s[0]).log1p();
        Eigen::MatrixXd columns(creep.size(), 2);
        columns << (creep * moved.array()).matrix(), (creep * (1.0 - moved.array())).matrix();
        return columns;
      });
  family.amplitudes[1].name = "in_calibration";
  family.parameters = [catalogue = named.catalogue()](const Eigen::VectorXd& shape, const Eigen::VectorXd& x,
                                                      const Eigen::MatrixXd& cov) {
    return std::vector{catalogue.Estimate("mount_creep", "amplitude", x[0], std::sqrt(cov(0, 0))),
                       catalogue.Estimate("mount_creep", "time_constant", shape[0], DeviationAt(cov, x.size()))};
  };
}

void AddTime(const SignalContext& c, const Schedule& s, Candidates& named) {
  for (const int k : {0, 1})
    named.AddDrift({"laser_drift", k == 0 ? "yaw" : "pitch", c.shown_by_laser.col(k)}, "drift", s.time_s);
  const Eigen::VectorXd above_K = model::Above_K(s, c.reference_degC);
  for (const char* where : {"yaw", "tilt"}) {
    AddCreep(c, s, where, named);
    if (!model::HasTemperature(s)) continue;
    named.AddOver(Moved("thermal_tilt", where, c), {"tilt_per_kelvin"},
                  {named.catalogue().ShapeOf("thermal_tilt", "lag", {0.0, 150.0, 300.0, 600.0, 900.0, 1350.0, 2000.0,
                                                                     3000.0})},
                  [time_s = s.time_s, above_K](const Eigen::VectorXd& lag_s) -> Eigen::MatrixXd {
                    return model::Lagged(time_s, above_K, lag_s[0]);
                  });
  }
}

/// Tilt of the target's body once in about two turns. The turns of a record that has been rewound may be counted
/// within a set-up or through all of them; a bearing may whirl with the angle or against it.
void AddHalfFrequency(const SignalContext& c, Candidates& named) {
  const std::string effect = "bearing_half_frequency";
  for (const bool through_setups : {false, true}) {
    for (const double sense : {1.0, -1.0}) {
      Family& family = named.AddOver(
          InRows(effect, ""), {"tilt", "tilt"},
          {named.catalogue().ShapeOf(effect, "order", Even(0.35, 0.65, 61))},
          [&c, through_setups, sense](const Eigen::VectorXd& order) {
            return HalfFrequencySignal(order[0], {through_setups, c.target_height_m, sense}, c);
          });
      family.parameters = [catalogue = named.catalogue(), effect](
                              const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
        const Polar polar = PolarOf(x, cov);  // the catalogue's has no phase, but a sign
        return std::vector{catalogue.Estimate(effect, "order", shape[0], DeviationAt(cov, 2)),
                           catalogue.Estimate(effect, "tilt", std::copysign(polar.size, x[0]), polar.u_size)};
      };
    }
  }
}

/// A rotor that lags stays behind on the side it came from; the reference turns against the target.
void AddTravel(const SignalContext& c, const Schedule& s, Candidates& named) {
  const auto yaw = [&](const char* effect, const char* where, double factor) {
    return Showing{effect, where, factor * WeightOf("yaw", c.shown_by_motion)};
  };
  named.Add(yaw("backlash", "target", -1.0), {"half_width"}, DirectionSignal(s));
  named.Add(yaw("backlash", "reference", 1.0), {"half_width"}, DirectionSignal(s));
  if (s.dwell_s.array().isFinite().any())
    named.AddOver(yaw("settling", "", -1.0), {"amplitude"},
                  {named.catalogue().ShapeOf("settling", "time_constant", Ratios(0.3, 4.0, 8))},
                  [&c, &s](const Eigen::VectorXd& tau_s) -> Eigen::MatrixXd {
                    return SettlingSignal(s, c.settle_s, tau_s[0]);
                  });
  AddHalfFrequency(c, named);
}

/// A step in a block's mean is as wide as the noise of its samples.
void AddSteps(const SignalContext& c, int channel, Candidates& named) {
  constexpr int kLevels = 200;
  constexpr double kLeastBlur_V = 0.2e-3;
  Eigen::VectorXd volts = c.shown_m(Eigen::seq(channel, Eigen::last, kChannels));
  volts *= c.sensitivity_V_m[static_cast<std::size_t>(channel / 2)];
  const std::vector<double> levels = Even(volts.minCoeff(), volts.maxCoeff(), kLevels);
  const double blur_V = std::max(kLeastBlur_V, c.sample_noise_V);
  named.AddOver(InRows("adc_step", ChannelName(channel)), {"step"},
                {named.catalogue().ShapeOf("adc_step", "at_voltage", levels)},
                [&c, channel, blur_V](const Eigen::VectorXd& at_V) -> Eigen::MatrixXd {
                  return AdcStepSignal(channel, at_V[0], blur_V, c);
                });
}

void AddElectronics(const SignalContext& c, Candidates& named) {
  for (int channel = 0; channel < kChannels; ++channel) {
    named.Add(InRows("crosstalk", ChannelName(channel)), {"fraction"}, CrosstalkRows(channel, c));
    AddSteps(c, channel, named);
  }
}

/// A tone with an amplitude and a phase of its own on every channel.
void AddFreeTone(const TimeSeries& series, Candidates& named) {
  if (!series.tones) return;
  named.AddTone({"tone", "all", Eigen::MatrixXd::Identity(kChannels, kChannels)}, series, true);
}

void AddPatterns(const SignalContext& c, const TimeSeries& series, Candidates& named) {
  for (int channel = 0; channel < kChannels; ++channel)
    named.AddTone({"tone", ChannelName(channel), Eigen::Vector4d::Unit(channel)}, series, true);
  named.AddTone({"tone", "yaw", Eigen::Vector4d(1.0, 0.0, 1.0, 0.0)}, series, true);
  named.AddTone({"tone", "tilt", Eigen::Vector4d(0.0, 1.0, 0.0, 1.0)}, series, true);
  named.AddTone({"tone", "all", Eigen::Vector4d::Ones()}, series, true);
  AddFreeTone(series, named);
  for (const char* where : {"yaw", "tilt", "lateral"})
    named.AddStep(Moved("slip", where, c), std::string(where) == "lateral" ? "shift" : "angle", series);
  named.AddStep({"mode_hop", "", c.shown_by_wavelength}, "wavelength_step", series);
}

/// What a wrong sensitivity to one motion adds: the motion itself, as it shows.
Eigen::VectorXd SensitivityColumn(const RotaryRun& rotary, int dof) {
  Eigen::VectorXd column(rotary.run.Rows());
  for (std::size_t i = 0; i < rotary.motion.size(); ++i)
    column.segment<4>(4 * static_cast<Eigen::Index>(i)) = rotary.shown_by_motion.col(dof) * rotary.motion[i][dof];
  return column;
}

Family ModelFamily(const std::string& where, const std::vector<Amplitude>& amplitudes, const Eigen::MatrixXd& rows) {
  Family family;
  family.effect = family.group = "published_sensitivity";
  family.where = where;
  family.amplitudes = amplitudes;
  family.columns = [rows](int) { return rows; };
  return family;
}

}  // namespace

std::vector<Family> ModelFamilies(const RotaryRun& rotary) {
  Eigen::MatrixXd both(rotary.run.Rows(), 2);
  both << SensitivityColumn(rotary, 0), SensitivityColumn(rotary, 1);
  const Amplitude yaw = {"yaw_scale_error", "1", 1.0, 0.1, -0.5, 0.5},
                  tilt = {"tilt_scale_error", "1", 1.0, 0.1, -0.5, 0.5};
  return {ModelFamily("yaw", {yaw}, both.leftCols(1)), ModelFamily("tilt", {tilt}, both.rightCols(1)),
          ModelFamily("yaw, tilt", {yaw, tilt}, both)};
}

std::vector<Family> NamedFamilies(const RotaryRun& rotary, const SignalContext& context, const Scenario& scenario,
                                  const TimeSeries& series) {
  Candidates named(Catalogue(benches::rotary::Format().effects), kChannels);
  AddBench(rotary, scenario, named);
  AddTime(context, rotary.run.schedule, named);
  AddTravel(context, rotary.run.schedule, named);
  AddElectronics(context, named);
  AddPatterns(context, series, named);
  std::vector<Family> families = named.Take();
  for (Family& family : families) {
    // A wrong sensitivity of both axes of a PSD looks the same.
    if (family.effect == "stray_light" || family.effect == "psd_distance")
      family.most_probable = kMostProbableDoubled;
  }
  return families;
}

}  // namespace twinbench::diagnose::rotary
