#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>

#include "twin/benches/rotary_4dof/diagnosis/families.h"
#include "twin/benches/rotary_4dof/diagnosis/signals.h"
#include "twin/benches/rotary_4dof/format.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/compensation_table.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/candidates.h"
#include "twin/diagnose/tuning.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::rotary {
namespace {

const char* ChannelName(int channel) {
  return kChannelNames[static_cast<std::size_t>(channel)];
}

/// How the channels respond to each point, asked of the twin once.
class Responses {
 public:
  explicit Responses(const RotaryRun& rotary) : rotary_(rotary) {}

  const RotaryRun& rotary() const { return rotary_; }
  const Response& To(const std::string& point) {
    const auto found = known_.find(point);
    return found != known_.end() ? found->second : known_.emplace(point, rotary_.ResponseTo(point)).first->second;
  }

 private:
  const RotaryRun& rotary_;
  std::map<std::string, Response> known_;
};

/// A cause that enters at a point of the twin: where it shows, and of what share of its course.
struct AtPoint {
  Showing showing;
  Eigen::VectorXd share;

  AtPoint(const std::string& effect, const std::string& where, Responses& responses, const std::string& point,
          double factor = 1.0) {
    const Response& response = responses.To(point);
    showing = {effect, where, factor * response.pattern};
    share = response.share;
  }

  Eigen::MatrixXd Of(const Eigen::MatrixXd& course) const { return model::Times(course, share); }
};

/// A cause whose signature is rows already.
Showing InRows(const std::string& effect, const std::string& where) {
  return {effect, where, {}};
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

/// Effect and parameter of causes that are a wrong constant of the bench.
constexpr std::array<std::array<const char*, 2>, 9> kBenchConstants = {{{"psd_gain", "gain_error"},
                                                                        {"psd_roll", "roll"},
                                                                        {"stray_light", "fraction"},
                                                                        {"background", "current"},
                                                                        {"psd_distance", "distance_error"},
                                                                        {"wavelength_offset", "wavelength_error"},
                                                                        {"grating_pitch", "pitch_error"},
                                                                        {"grating_form", "height"},
                                                                        {"incidence_offset", "incidence"}}};

void AddBench(const RotaryRun& rotary, const Scenario& scenario, Candidates& named) {
  constexpr double kStep = 0.01;  // of a plausible size
  for (const auto& [effect, parameter] : kBenchConstants) {
    std::vector<std::string> places = FindEffect(effect, scenario.bench)->places;
    if (places.empty()) places = {""};
    const double step = kStep * named.catalogue().AmplitudeOf(effect, parameter).prior_sd;
    for (const std::string& where : places)
      named.Add(InRows(effect, where), {parameter},
                rotary.twin->Slope_m({effect, where, parameter}, step, rotary.free));
  }
  AddNonlinearities(rotary, named);
}

/// A set-up takes its time between the mounting and the first reading, in which the mount has crept already.
Eigen::VectorXd SinceMounting_s(const Schedule& s, double remount_s) {
  return model::SinceFirst_s(s).array() + remount_s;
}

void AddTime(Responses& responses, const Scenario& scenario, Candidates& named) {
  const Schedule& s = responses.rotary().run.schedule;
  for (const char* where : {"yaw", "pitch"})
    named.AddDrift(AtPoint("laser_drift", where, responses, std::string("laser.") + where).showing, "drift",
                   s.time_s);
  const Shape time_constant = named.catalogue().ShapeOf("mount_creep", "time_constant", Ratios(5.0, 1500.0, 7));
  for (const char* where : {"yaw", "tilt"}) {
    const AtPoint at("mount_creep", where, responses, std::string("grating.") + where);
    named.AddOver(at.showing, {"amplitude"}, {time_constant},
                  [at, since_s = SinceMounting_s(s, RotaryOf(scenario).procedure.remount_s)](const Eigen::VectorXd& tau_s) {
                    return at.Of((since_s.array() / tau_s[0]).log1p().matrix());
                  });
  }
  if (!model::HasTemperature(s)) return;
  const Eigen::VectorXd above_K = model::Above_K(s, scenario.environment.reference_degC);
  const AtPoint laser("wavelength_temperature", "", responses, "laser.wavelength");
  named.Add(laser.showing, {"wavelength_per_kelvin"}, laser.Of(above_K));
  for (int psd = 0; psd < 2; ++psd)
    named.Add({"post_growth", psd == 0 ? "psd_a" : "psd_b", -Eigen::Vector4d::Unit(2 * psd + 1)},
              {"growth_per_kelvin"}, above_K);
  const Shape lag =
      named.catalogue().ShapeOf("thermal_tilt", "lag", {0.0, 150.0, 300.0, 600.0, 900.0, 1350.0, 2000.0, 3000.0});
  for (const char* where : {"yaw", "tilt"}) {
    const AtPoint at("thermal_tilt", where, responses, std::string("grating.") + where);
    named.AddOver(at.showing, {"tilt_per_kelvin"}, {lag},
                  [at, time_s = s.time_s, above_K](const Eigen::VectorXd& lag_s) {
                    return at.Of(model::Lagged(time_s, above_K, lag_s[0]));
                  });
  }
}

/// Tilt of the target's body once in about two turns. The turns of a record that has been rewound may be counted
/// within a set-up or through all of them; a bearing may whirl with the angle or against it.
void AddHalfFrequency(Responses& responses, Candidates& named) {
  const std::string effect = "bearing_half_frequency";
  const Schedule& s = responses.rotary().run.schedule;
  const Vector4 ex = responses.To("target.ex").pattern;
  for (const double sense : {1.0, -1.0}) {
    const Vector4 ey = sense * responses.To("target.ey").pattern;
    for (const bool through_setups : {false, true}) {
      const Eigen::VectorXd angle_rad = ContinuedTarget_rad(s, through_setups);
      Family& family = named.AddOver(
          InRows(effect, ""), {"tilt", "tilt"}, {named.catalogue().ShapeOf(effect, "order", Even(0.35, 0.65, 61))},
          [=, moved = InCircle(s)](const Eigen::VectorXd& order) {
            const Eigen::MatrixXd wave = model::Times(model::Wave(order[0] * angle_rad), moved);
            Eigen::MatrixXd rows(kChannels * wave.rows(), 2);
            rows.col(0) = OnChannels(wave.col(0), ex) + OnChannels(wave.col(1), ey);
            rows.col(1) = OnChannels(-wave.col(1), ex) + OnChannels(wave.col(0), ey);
            return rows;
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

/// A servo stands where its encoder shows the command, wherever the command lies in a period of the graduation.
void AddSubdivision(Responses& responses, const RotarySettings& own, Candidates& named) {
  const Schedule& s = responses.rotary().run.schedule;
  const auto add = [&](const char* where, const TableSettings& table, const Eigen::VectorXd& angle_rad) {
    const AtPoint at("encoder_subdivision", where, responses, std::string(where) + ".yaw", -1.0);
    const auto sine = [&](double told_rad) {
      return std::sin(own.mechanics.encoder_periods * CommandedAngle_rad(table.compensation, told_rad));
    };
    named.Add(at.showing, {"amplitude"}, at.Of(angle_rad.unaryExpr(sine)));
  };
  add("target", own.target, s.target_rad);
  add("reference", own.reference, s.reference_rad);
}

/// A rotor that lags stays behind on the side it came from; the reference turns against the target.
void AddTravel(Responses& responses, double settle_s, Candidates& named) {
  const Schedule& s = responses.rotary().run.schedule;
  named.Add(AtPoint("backlash", "target", responses, "target.yaw", -1.0).showing, {"half_width"},
            DirectionSignal(s));
  named.Add(AtPoint("backlash", "reference", responses, "reference.yaw", 1.0).showing, {"half_width"},
            DirectionSignal(s));
  const auto waits_s = s.dwell_s.array();
  if (waits_s.isFinite().any()) {
    const double soonest_s = settle_s + waits_s.isFinite().select(waits_s, 1e9).minCoeff();
    named.AddSettling(AtPoint("settling", "", responses, "target.yaw", -1.0).showing, std::max(soonest_s, 0.1),
                      [s, settle_s](const Eigen::VectorXd& tau_s) -> Eigen::MatrixXd {
                        return SettlingSignal(s, settle_s, tau_s[0]);
                      });
  }
  AddHalfFrequency(responses, named);
}

/// A step in a channel's A/D: the share of a block's samples above it, as wide as their noise, per sensitivity.
Eigen::VectorXd AdcStep_m(const Eigen::VectorXd& shown_m, double at_V, double blur_V, double sensitivity_V_m) {
  const double width_V = std::sqrt(2.0) * blur_V;
  return shown_m.unaryExpr(
      [=](double m) { return 0.5 * std::erfc((at_V - m * sensitivity_V_m) / width_V) / sensitivity_V_m; });
}

void AddSteps(const RotaryRun& rotary, int channel, Candidates& named) {
  constexpr int kLevels = 200;
  constexpr double kLeastBlur_V = 0.2e-3;
  const double sensitivity_V_m = rotary.geometry.sensitivity_V_m[static_cast<std::size_t>(channel / 2)];
  const Eigen::VectorXd shown_m = rotary.run.Predicted()(Eigen::seq(channel, Eigen::last, kChannels));
  const std::vector<double> levels_V =
      Even(sensitivity_V_m * shown_m.minCoeff(), sensitivity_V_m * shown_m.maxCoeff(), kLevels);
  const double blur_V = std::max(kLeastBlur_V, rotary.sample_noise_V);
  named.AddOver({"adc_step", ChannelName(channel), Eigen::Vector4d::Unit(channel)}, {"step"},
                {named.catalogue().ShapeOf("adc_step", "at_voltage", levels_V)},
                [=](const Eigen::VectorXd& at_V) -> Eigen::MatrixXd {
                  return AdcStep_m(shown_m, at_V[0], blur_V, sensitivity_V_m);
                });
}

/// A tone with an amplitude and a phase of its own on every channel.
void AddFreeTone(const TimeSeries& series, Candidates& named) {
  if (!series.tones) return;
  named.AddTone({"tone", "all", Eigen::MatrixXd::Identity(kChannels, kChannels)}, series, true);
}

/// What a channel keeps of the one that is converted just before it; the first follows the last of the scan before.
void AddCrosstalk(const RotaryRun& rotary, const std::vector<std::string>& scan_list, Candidates& named) {
  const Eigen::VectorXd shown_m = rotary.run.Predicted();
  const auto channel_of = [&scan_list](std::size_t at) {
    const std::string& name = scan_list[at % scan_list.size()];
    return static_cast<int>(std::ranges::find(kChannelNames, name) - kChannelNames.begin());
  };
  for (std::size_t k = 0; k < scan_list.size(); ++k) {
    const int channel = channel_of(k), before = channel_of(k + scan_list.size() - 1);
    named.Add({"crosstalk", ChannelName(channel), Eigen::Vector4d::Unit(channel)}, {"fraction"},
              shown_m(Eigen::seq(before, Eigen::last, kChannels)));
  }
}

/// Steps as a point shows them: while the calibration is read, the autocollimator follows a grating that slips.
TimeSeries ShownSteps(const TimeSeries& series, const Eigen::VectorXd& share) {
  TimeSeries shown = series;
  if (!series.steps || share.isOnes()) return shown;
  auto steps = std::make_shared<Base>(*series.steps);
  steps->series = [of_all = series.steps->series, share](int k) { return model::Times(of_all(k), share); };
  steps->sums = {};
  shown.steps = steps;
  return shown;
}

void AddPatterns(Responses& responses, const TimeSeries& series, Candidates& named) {
  for (int channel = 0; channel < kChannels; ++channel)
    named.AddTone({"tone", ChannelName(channel), Eigen::Vector4d::Unit(channel)}, series, true);
  named.AddTone({"tone", "yaw", Eigen::Vector4d(1.0, 0.0, 1.0, 0.0)}, series, true);
  named.AddTone({"tone", "tilt", Eigen::Vector4d(0.0, 1.0, 0.0, 1.0)}, series, true);
  named.AddTone({"tone", "all", Eigen::Vector4d::Ones()}, series, true);
  AddFreeTone(series, named);
  for (const char* where : {"yaw", "tilt", "lateral"}) {
    const AtPoint at("slip", where, responses, std::string("grating.") + where);
    named.AddStep(at.showing, std::string(where) == "lateral" ? "shift" : "angle", ShownSteps(series, at.share));
  }
  named.AddStep(AtPoint("mode_hop", "", responses, "laser.wavelength").showing, "wavelength_step", series);
}

/// What a wrong sensitivity to one motion adds: the motion itself, as it shows.
Eigen::VectorXd SensitivityColumn(const RotaryRun& rotary, int dof) {
  Eigen::VectorXd column(rotary.run.Rows());
  for (std::size_t i = 0; i < rotary.motion.size(); ++i)
    column.segment<4>(4 * static_cast<Eigen::Index>(i)) = rotary.shown_by_motion.col(dof) * rotary.motion[i][dof];
  return column;
}

Family ModelFamily(const std::string& where, const std::vector<Amplitude>& amplitudes,
                   const Eigen::MatrixXd& rows) {
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

bool IsOfBench(const std::string& effect) {
  return effect == "psd_nonlinearity" ||
         std::ranges::any_of(kBenchConstants, [&](const auto& constant) { return effect == constant[0]; });
}

std::vector<Family> NamedFamilies(const RotaryRun& rotary, const Scenario& scenario, const TimeSeries& series) {
  Candidates named(Catalogue(benches::rotary::Format().effects), kChannels);
  Responses responses(rotary);
  AddBench(rotary, scenario, named);
  AddTime(responses, scenario, named);
  AddTravel(responses, std::max(RotaryOf(scenario).target.settle_s, RotaryOf(scenario).reference.settle_s), named);
  AddSubdivision(responses, RotaryOf(scenario), named);
  for (int channel = 0; channel < kChannels; ++channel) AddSteps(rotary, channel, named);
  AddCrosstalk(rotary, RotaryOf(scenario).adc.scan_list, named);
  AddPatterns(responses, series, named);
  std::vector<Family> families = named.Take();
  for (Family& family : families) {
    // A wrong sensitivity of both axes of a PSD looks the same.
    if (family.effect == "stray_light" || family.effect == "background" || family.effect == "psd_distance")
      family.listed = tuning::kListedDoubled;
  }
  return families;
}

}  // namespace twinbench::diagnose::rotary
