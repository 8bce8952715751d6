#include "twin/diagnose/json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/diagnose/shown.h"

namespace twinbench::diagnose {
namespace {

using nlohmann::json;

json Number(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

json ToJson(const ParameterEstimate& p) {
  return {{"value", Number(p.value / p.to_SI)},
          {"u", Number(p.u / p.to_SI)},
          {"unit", p.unit},
          {"lower", Number(p.lower / p.to_SI)},
          {"upper", Number(p.upper / p.to_SI)}};
}

json ToJson(const Cause& cause) {
  json out = {{"effect", cause.effect},
              {"where", cause.where},
              {"probability", Number(cause.probability)},
              {"log_evidence", Number(cause.log_evidence)},
              {"rho", Number(cause.rho)},
              {"parameters", json::object()},
              {"indistinguishable_from", json::array()},
              {"next_measurement", cause.next_measurement}};
  for (const ParameterEstimate& p : cause.parameters) out["parameters"][p.name] = ToJson(p);
  for (const Rival& rival : cause.indistinguishable_from) {
    out["indistinguishable_from"].push_back(
        {{"effect", rival.effect}, {"where", rival.where}, {"overlap", Number(rival.overlap)}});
  }
  return out;
}

json ToJson(const Invisible& invisible) {
  return {{"effect", invisible.effect}, {"where", invisible.where}, {"could_bias", invisible.could_bias}};
}

json ToJson(const Harmonic& h) {
  return {{"order", h.order},
          {"amplitude_deg", Number(h.amplitude_rad / units::deg)},
          {"u_amplitude_deg", Number(h.u_amplitude_rad / units::deg)},
          {"phase_deg", Number(h.phase_rad / units::deg)},
          {"u_phase_deg", Number(h.u_phase_rad / units::deg)},
          {"meaning", h.meaning}};
}

json ToJson(const Detectable& detectable) {
  return {{"effect", detectable.effect},
          {"where", detectable.where},
          {"parameter", detectable.smallest.name},
          {"smallest", Number(detectable.smallest.value / detectable.smallest.to_SI)},
          {"unit", detectable.smallest.unit}};
}

template <class List>
json ArrayOf(const List& list) {
  json out = json::array();
  for (const auto& entry : list) out.push_back(ToJson(entry));
  return out;
}

/// Peak to valley of what a term shows along the radius of a circle, about the centre of each mounting: what it adds to G(b) by
/// itself. NaN on a bench that has no radii.
double ShareOfG_m(const DiagnosisRun& found, const Accepted& term) {
  const LinearRun& run = found.run;
  if (run.channels.front() != "radial") return kNaN;
  const auto radii = Eigen::seq(0, Eigen::last, run.Channels());
  const Eigen::VectorXd shown = (term.columns * term.amplitudes)(radii);
  const Eigen::MatrixXd free = Eigen::MatrixXd(run.nuisance.jacobian)(radii, Eigen::all);
  const Eigen::VectorXd about = shown - free * SolveLeastSquares(free, shown);
  double largest_m = 0.0;
  for (const int setup : std::set<int>(run.schedule.setup.begin(), run.schedule.setup.end())) {
    double low_m = kNaN, high_m = kNaN;
    for (Eigen::Index i = 0; i < about.size(); ++i) {
      if (run.schedule.setup[static_cast<std::size_t>(i)] != setup) continue;
      low_m = std::fmin(low_m, about[i]);
      high_m = std::fmax(high_m, about[i]);
    }
    largest_m = std::max(largest_m, high_m - low_m);
  }
  return largest_m;
}

/// What each cause explains, and of circles what it adds to G(b); of a tie what its fitted member does.
json CausesJson(const DiagnosisRun& found) {
  json causes = ArrayOf(found.diagnosis.causes);
  if (found.run.Rows() == 0 || found.accepted.empty()) return causes;
  const std::vector<double> share = ShownBy(found).share;
  for (std::size_t k = 0; k < causes.size(); ++k) {
    if (std::isfinite(share[k])) causes[k]["share"] = share[k];
    for (const Accepted& term : found.accepted) {
      const double G_m = term.family.effect == found.diagnosis.causes[k].effect && term.family.where == found.diagnosis.causes[k].where
                             ? ShareOfG_m(found, term)
                             : kNaN;
      if (std::isfinite(G_m)) causes[k]["share_um"] = G_m / units::um;
    }
  }
  return causes;
}

/// Metres on the PSD that one radian of the grating's yaw makes, at most; 1 on a bench that reads angles, NaN on
/// one that reads neither.
double ShownByYaw(const LinearRun& run) {
  for (const Pattern& pattern : run.patterns) {
    if (pattern.name == "yaw") return pattern.weight.cwiseAbs().maxCoeff();
  }
  return run.unit == "um" || run.IsMixed() ? kNaN : 1.0;
}

json GainJson(const Gain& gain, const LinearRun& run) {
  json out = {{"fraction_removed", Number(gain.fraction_removed)},
              {"interval95", {Number(gain.interval95[0]), Number(gain.interval95[1])}},
              {"another_run", Number(gain.another_run)},
              {"positive", gain.positive},
              {"folds", gain.folds}};
  const bool is_length = run.unit == "um";
  const auto add = [&](const std::string& key, double value_SI) {
    out[key + "_um"] = is_length ? Number(value_SI / units::um) : json(nullptr);
    out[key + "_arcsec"] = Number(value_SI / ShownByYaw(run) / units::arcsec);
    if (run.IsMixed()) out[key + "_over_noise"] = Number(value_SI / gain.noise_floor_m);
  };
  add("heldout_rms_before", gain.before_m);
  add("heldout_rms_after", gain.after_m);
  add("noise_floor", gain.noise_floor_m);
  return out;
}

}  // namespace

json ToJson(const std::vector<ResidualTest>& tests) {
  json list = json::array();
  for (const ResidualTest& test : tests) {
    list.push_back({{"test", test.name},
                    {"statistic", Number(test.statistic)},
                    {"p", Number(test.p)},
                    {"effect_um", Number(test.effect_m / units::um)},
                    {"effect_arcsec", Number(test.effect_rad / units::arcsec)},
                    {"reading", test.reading},
                    {"items", test.tables}});
  }
  return list;
}

json ToJson(const DiagnosisRun& run, const std::string& extended_scenario) {
  const Diagnosis& d = run.diagnosis;
  return {{"verdict", VerdictName(d.verdict)},
          {"alarm_p", Number(d.alarm_p)},
          {"causes", CausesJson(run)},
          {"unknown", {{"probability", Number(d.unknown.probability)}, {"signature", d.unknown.signature}}},
          {"gain", GainJson(d.gain, run.run)},
          {"invisible", ArrayOf(d.invisible)},
          {"detectable", ArrayOf(d.detectable)},
          {"harmonics", ArrayOf(d.harmonics)},
          {"noise", d.noise},
          {"notes", d.notes},
          {"readings", d.readings},
          {"left_out", d.left_out},
          {"extended_scenario", extended_scenario.empty() ? json(nullptr) : json(extended_scenario)}};
}

}  // namespace twinbench::diagnose
