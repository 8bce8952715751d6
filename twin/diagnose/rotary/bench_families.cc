#include <array>
#include <map>
#include <utility>

#include "twin/core/effect_catalogue.h"
#include "twin/diagnose/rotary/family_parts.h"
#include "twin/diagnose/rotary/signals.h"

namespace twinbench::diagnose::rotary {
namespace {

/// How the readings change with one property of the bench as it is believed, by central differences.
Eigen::VectorXd BenchColumn(const RotaryRun& rotary, const Scenario& scenario, const std::string& effect,
                            const std::string& where, const Parameters& step) {
  const Eigen::VectorXd above_K = LaggedTemperature(rotary.run.schedule, scenario.environment.reference_degC, 0.0);
  Parameters back = step;
  for (auto& parameter : back) parameter.second = -parameter.second;
  Eigen::VectorXd column(rotary.run.Rows());
  for (std::size_t i = 0; i < rotary.motion.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    OpticalBench more = WithKnownEffects(rotary.bench, scenario, above_K[at]), less = more;
    AlterBench(effect, where, step, above_K[at], more);
    AlterBench(effect, where, back, above_K[at], less);
    column.segment<4>(4 * at) = (ShownSpots(more, rotary.motion[i]) - ShownSpots(less, rotary.motion[i])) / 2.0;
  }
  return column;
}

Family BenchFamily(const std::string& effect, const std::string& where, const std::string& parameter,
                   const RotaryRun& rotary, const Scenario& scenario) {
  Family family = Named(effect, where, {AmplitudeOf(effect, parameter)});
  const double step = 0.01 * family.amplitudes[0].prior_sd;
  const Eigen::MatrixXd column = BenchColumn(rotary, scenario, effect, where, {{parameter, step}}) / step;
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

/// What a wrong sensitivity to one motion adds: the motion itself, as it shows.
Eigen::VectorXd SensitivityColumn(const RotaryRun& rotary, int dof) {
  Eigen::VectorXd column(rotary.run.Rows());
  for (std::size_t i = 0; i < rotary.motion.size(); ++i) {
    column.segment<4>(4 * static_cast<Eigen::Index>(i)) = rotary.shown_by_motion.col(dof) * rotary.motion[i][dof];
  }
  return column;
}

}  // namespace

void AddBenchFamilies(const RotaryRun& rotary, const Scenario& scenario, std::vector<Family>& families) {
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
    for (const std::string& where : places) {
      families.push_back(BenchFamily(effect, where, parameter, rotary, scenario));
    }
  }
  AddNonlinearities(rotary, families);
  for (Family& family : families) {
    // A wrong sensitivity of both axes of a PSD looks the same.
    if (family.effect == "stray_light" || family.effect == "psd_distance")
      family.most_probable = kMostProbableDoubled;
  }
}

std::vector<Family> ModelFamilies(const RotaryRun& rotary) {
  Eigen::MatrixXd both(rotary.run.Rows(), 2);
  both << SensitivityColumn(rotary, 0), SensitivityColumn(rotary, 1);
  const Amplitude yaw = {"yaw_scale_error", "1", 1.0, 0.1, -0.5, 0.5},
                  tilt = {"tilt_scale_error", "1", 1.0, 0.1, -0.5, 0.5};
  std::vector<Family> families = {Named("published_sensitivity", "yaw", {yaw}),
                                  Named("published_sensitivity", "tilt", {tilt}),
                                  Named("published_sensitivity", "yaw, tilt", {yaw, tilt})};
  families[0].columns = [both](int) { return Eigen::MatrixXd(both.leftCols(1)); };
  families[1].columns = [both](int) { return Eigen::MatrixXd(both.rightCols(1)); };
  families[2].columns = [both](int) { return both; };
  return families;
}

}  // namespace twinbench::diagnose::rotary
