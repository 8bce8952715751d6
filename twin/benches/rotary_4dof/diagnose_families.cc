#include <algorithm>
#include <array>
#include <cmath>

#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/diagnose.h"
#include "twin/benches/rotary_4dof/estimators/grating_model.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/candidates.h"
#include "twin/model/signals.h"

namespace twinbench::benches::rotary {
namespace {

using diagnose::Candidates;
using diagnose::Family;

/// Rows of a pattern: weight of each channel times the signals (readings x k -> rows x k).
Eigen::MatrixXd OnChannels(const Eigen::MatrixXd& signals, const Eigen::VectorXd& weight) {
  return diagnose::OnEachChannel(signals, static_cast<int>(weight.size())) *
         diagnose::PatternMap(weight, signals.cols());
}

Eigen::VectorXd InCircle(const diagnose::Schedule& s) {
  Eigen::VectorXd in(s.Readings());
  for (std::size_t i = 0; i < s.phase.size(); ++i)
    in[static_cast<Eigen::Index>(i)] = s.phase[i] == Phase::kFullCircle ? 1.0 : 0.0;
  return in;
}

/// Target angle with its turns counted on: where a pass goes on in the direction of the one before, the recorded
/// angle may have been rewound by a turn. Starts anew in every set-up unless `through_setups`.
Eigen::VectorXd ContinuedTarget_rad(const diagnose::Schedule& s, bool through_setups) {
  Eigen::VectorXd angle_rad = s.target_rad;
  double offset_rad = 0.0;
  for (Eigen::Index i = 1; i < angle_rad.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const bool is_same_setup = s.setup[at] == s.setup[at - 1];
    if (!is_same_setup && !through_setups) offset_rad = 0.0;
    const double moved_rad = s.target_rad[i] - s.target_rad[i - 1];
    const bool rewound = s.direction[at] == s.direction[at - 1] && s.phase[at] == Phase::kFullCircle &&
                         moved_rad * s.direction[at] < -units::kPi;
    if (rewound && is_same_setup)
      offset_rad += s.direction[at] * units::turn * std::ceil(std::abs(moved_rad) / units::turn);
    angle_rad[i] += offset_rad;
  }
  return angle_rad;
}

/// Spots from their mean in each set-up and phase: as the PSD sees them if it is centred anew after every mounting.
Eigen::VectorXd CentredSpots_m(const diagnose::Compared& c) {
  const diagnose::Schedule& s = c.run.schedule;
  std::vector<int> mounting;
  for (std::size_t i = 0; i < s.reading.size(); ++i)
    mounting.push_back(2 * s.setup[i] + (s.phase[i] == Phase::kCalibration ? 1 : 0));
  const Eigen::MatrixXd which = model::Indicators(mounting);
  const Eigen::VectorXd count = which.colwise().sum();
  Eigen::VectorXd centred_m = c.predicted;
  for (int channel = 0; channel < kChannels; ++channel) {
    const auto rows = Eigen::seq(channel, Eigen::last, kChannels);
    const Eigen::VectorXd of_channel = centred_m(rows), mean = (which.transpose() * of_channel).cwiseQuotient(count);
    centred_m(rows) -= which * mean;
  }
  return centred_m;
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

/// Electrodes bend higher orders than the twin's: r^4 comes along with r^2, a fifth of it at a typical spot.
void AddNonlinearities(const diagnose::Compared& c, Candidates& named) {
  constexpr double kTypicalSpot_m = 0.4e-3;
  for (int psd = 0; psd < 2; ++psd) {
    for (const Eigen::VectorXd& spots_m : {c.predicted, CentredSpots_m(c)}) {
      Family& family = named.Add({"psd_nonlinearity", psd == 0 ? "psd_a" : "psd_b", {}}, {"cubic", "cubic"},
                                 PincushionColumns(spots_m, psd));
      const double cubic_per_m2 = family.amplitudes[0].prior_sd;
      family.amplitudes[1] = {"quintic", "per_m4", 1.0, 0.2 * cubic_per_m2 / (kTypicalSpot_m * kTypicalSpot_m)};
    }
  }
}

/// Tilt of the target's body once in about two turns, of any phase. The turns of a record that has been rewound may be
/// counted within a set-up or through all of them; a bearing may whirl with the angle or against it.
void AddHalfFrequency(const diagnose::Compared& c, Candidates& named) {
  const std::string effect = "bearing_half_frequency";
  const Eigen::VectorXd ex = ResponseTo(c, "target.ex").pattern, ey_of_one = ResponseTo(c, "target.ey").pattern;
  for (const double sense : {1.0, -1.0}) {
    for (const bool through_setups : {false, true}) {
      Family& family = named.AddOver(
          {effect, "", {}}, {"tilt", "tilt"},
          {named.catalogue().ShapeOf(effect, "order", diagnose::Even(0.35, 0.65, 61))},
          [ex, ey = Eigen::VectorXd(sense * ey_of_one), moved = InCircle(c.run.schedule),
           angle_rad = ContinuedTarget_rad(c.run.schedule, through_setups)](const Eigen::VectorXd& order) {
            const Eigen::MatrixXd wave = model::Times(model::Wave(order[0] * angle_rad), moved);
            Eigen::MatrixXd rows(kChannels * wave.rows(), 2);
            rows.col(0) = OnChannels(wave.col(0), ex) + OnChannels(wave.col(1), ey);
            rows.col(1) = OnChannels(-wave.col(1), ex) + OnChannels(wave.col(0), ey);
            return rows;
          });
      family.parameters = [catalogue = named.catalogue(), effect](
                              const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
        const diagnose::Polar polar = diagnose::PolarOf(x, cov);  // the catalogue's has no phase, but a sign
        return std::vector{catalogue.Estimate(effect, "order", shape[0], diagnose::DeviationAt(cov, 2)),
                           catalogue.Estimate(effect, "tilt", std::copysign(polar.size, x[0]), polar.u_size)};
      };
    }
  }
}

/// A step in a channel's A/D: the share of a block's samples above it, as wide as their noise.
void AddAdcSteps(const diagnose::Compared& c, const Scenario& scenario, double sample_V, Candidates& named) {
  constexpr int kLevels = 200;
  constexpr double kLeastBlur_V = 0.2e-3;
  const double width_V = std::sqrt(2.0) * std::max(kLeastBlur_V, sample_V);
  for (int channel = 0; channel < kChannels; ++channel) {
    const RotarySettings& own = RotaryOf(scenario);
    const double V_m = (channel < 2 ? own.psd_a : own.psd_b).sensitivity_V_m;
    const Eigen::VectorXd shown_V = V_m * c.predicted(Eigen::seq(channel, Eigen::last, kChannels));
    named.AddOver({"adc_step", kChannelNames[static_cast<std::size_t>(channel)], Eigen::Vector4d::Unit(channel)},
                  {"step"},
                  {named.catalogue().ShapeOf("adc_step", "at_voltage",
                                             diagnose::Even(shown_V.minCoeff(), shown_V.maxCoeff(), kLevels))},
                  [=](const Eigen::VectorXd& at_V) -> Eigen::MatrixXd {
                    return shown_V.unaryExpr(
                        [=](double V) { return 0.5 * std::erfc((at_V[0] - V) / width_V) / V_m; });
                  });
  }
}

/// With the published equations as the model: a wrong sensitivity to a motion adds the motion itself, as it shows.
std::vector<Family> SensitivityFamilies(const diagnose::Compared& c, const measure::BenchGeometry& geometry) {
  Eigen::MatrixXd both(c.run.Rows(), 2);
  for (Eigen::Index row = 0; row < both.rows(); row += kChannels) {
    const Eigen::Vector4d motion = measure::SolveMotion(c.predicted.segment<kChannels>(row), geometry).motion;
    for (Eigen::Index k = 0; k < 2; ++k)
      both.block<kChannels, 1>(row, k) = motion[k] * c.run.patterns[static_cast<std::size_t>(k)].weight;
  }
  const diagnose::Amplitude yaw = {"yaw_scale_error", "1", 1.0, 0.1, -0.5, 0.5},
                            tilt = {"tilt_scale_error", "1", 1.0, 0.1, -0.5, 0.5};
  std::vector<Family> families;
  const auto add = [&](const std::string& where, const std::vector<diagnose::Amplitude>& amplitudes,
                       const Eigen::MatrixXd& rows) {
    Family& family = families.emplace_back();
    family.effect = family.group = "published_sensitivity";
    family.where = where;
    family.amplitudes = amplitudes;
    family.columns = [rows](int) { return rows; };
  };
  add("yaw", {yaw}, both.leftCols(1));
  add("tilt", {tilt}, both.rightCols(1));
  add("yaw, tilt", {yaw, tilt}, both);
  return families;
}

/// "psd_b_y" or "psd_a_y, psd_b_y in phase (tilt pattern)".
std::string OnWhat(const std::string& place) {
  if (place == "yaw") return "psd_a_x, psd_b_x in phase (yaw pattern)";
  if (place == "tilt") return "psd_a_y, psd_b_y in phase (tilt pattern)";
  if (place == "roll") return "psd_a_y, psd_b_y in antiphase (roll pattern)";
  if (place == "lateral") return "psd_a_x, psd_b_x in antiphase (lateral pattern)";
  return place;
}

/// A motion of the grating, a channel, or all channels independently.
std::vector<diagnose::unknown::Place> GenericPlaces(const diagnose::LinearRun& run) {
  std::vector<diagnose::unknown::Place> places;
  for (const diagnose::Pattern& motion : run.patterns)
    places.push_back({motion.name, OnWhat(motion.name), motion.weight / motion.weight.cwiseAbs().maxCoeff()});
  for (int c = 0; c < kChannels; ++c) {
    const char* const name = kChannelNames[static_cast<std::size_t>(c)];
    places.push_back({name, name, Eigen::Vector4d::Unit(c)});
  }
  places.push_back({"all", "all channels", Eigen::MatrixXd::Identity(kChannels, kChannels)});
  return places;
}

}  // namespace

std::vector<Family> OwnFamilies(const diagnose::Compared& c, const Scenario& scenario, double sample_V,
                                bool published) {
  Candidates named(diagnose::Catalogue(Format().effects), kChannels);
  AddNonlinearities(c, named);
  AddHalfFrequency(c, named);
  AddAdcSteps(c, scenario, sample_V, named);
  std::vector<Family> families = named.Take();
  if (!published) return families;
  std::ranges::move(SensitivityFamilies(c, measure::NominalGeometry(scenario)), std::back_inserter(families));
  return families;
}

void SetStructure(const diagnose::Compared& c, const Scenario& scenario, diagnose::unknown::Design& design) {
  const diagnose::Schedule& s = c.run.schedule;
  const int last = std::min(12, (RotaryOf(scenario).procedure.positions - 1) / 2);
  design.places = GenericPlaces(c.run);
  // Every order of both tables is free.
  design.angles = {{"target angle", s.target_rad, last, 0, "harmonic", "target"},
                   {"reference angle", s.reference_rad, last, 0, "harmonic", "reference"}};
  design.continued_rad = ContinuedTarget_rad(s, false);
  design.moved = InCircle(s);
  // A goniometer's sweep does not turn the tables.
  design.senses = {Eigen::Map<const Eigen::VectorXi>(s.direction.data(), s.Readings()).cast<double>().cwiseProduct(design.moved)};
  design.twin_is_warm = true;
  if (model::HasTemperature(s)) design.above_K = model::Above_K(s, scenario.environment.reference_degC);
  design.shown_name = "spot";
  design.detectors = {{0, 1}, {2, 3}};
  design.plausible = 0.5 * units::um;
  design.plausible_share = 0.005;
  design.named = {{"tone", "tone"}, {"step", "slip"}, {"direction offset", ""}, {"trend", ""}, {"slope", ""}, {"restart", ""}, {"temperature", ""}};
}

}  // namespace twinbench::benches::rotary
