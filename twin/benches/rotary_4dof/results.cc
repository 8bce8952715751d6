#include <fmt/core.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/rotary_4dof/analysis.h"
#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/columns.h"
#include "twin/benches/rotary_4dof/parts_of_results.h"
#include "twin/benches/rotary_4dof/tables.h"
#include "twin/benches/rotary_4dof/uncertainty_parts.h"
#include "twin/core/errors.h"
#include "twin/report/sound.h"

namespace twinbench::benches::rotary {
namespace {

/// What others script against (formats.md); results.json of a run has the rest.
nlohmann::json Agreed(const nlohmann::json& all) {
  nlohmann::json agreed;
  for (const char* key : {"target", "reference", "not_separable", "residual_rms", "dof"}) agreed[key] = all.at(key);
  return agreed;
}

TableErrors ErrorsOf(const nlohmann::json& truth, const std::string& table) {
  TableErrors errors;
  for (const double angle_deg : truth.at(table).at("position_deg"))
    errors.position_rad.push_back(angle_deg * units::deg);
  for (int c = 0; c < kComponents; ++c) {
    const bool angle = IsAngle(static_cast<Component>(c));
    const std::string column = std::string(kComponentNames[c]) + (angle ? "_arcsec" : "_um");
    for (const double v : truth.at(table).at(column))
      errors.value[c].push_back(v * (angle ? units::arcsec : units::um));
  }
  return errors;
}

/// A detector that is not linear leaves ten times the noise, and a diagnosis names it. What leaves more is not seen
/// by the detectors alone: light that goes another way to them, or spots beyond what they can show.
constexpr double kMostOfSweeps = 20.0;

std::vector<report::Misfit> MisfitsOf(const separate::Separation& s, const measure::Calibration& c) {
  std::vector<report::Misfit> misfits;
  const double of_sweeps = c.dof > 0 ? std::sqrt(c.chi2 / c.dof) : 0.0;
  if (of_sweeps > kMostOfSweeps) misfits.push_back({"the calibration", of_sweeps});
  for (int d = 0; d < 4; ++d)
    if (s.dof_of[d] >= 1.0)
      misfits.push_back(report::WidenedMisfit(std::array{"ez", "ex", "ey", "dy"}[static_cast<std::size_t>(d)],
                                              std::sqrt(s.chi2[d] / s.dof_of[d])));
  return misfits;
}

/// Wires that are not where the scenario has them: what each channel really is, and its sign.
struct Wiring {
  const char* what;
  std::array<std::size_t, kChannels> channel;
  std::array<double, kChannels> sign;
};
constexpr std::array<Wiring, 7> kMiswired = {{{"PSD a and b exchanged", {2, 3, 0, 1}, {1, 1, 1, 1}},
                                              {"x and y of PSD a exchanged", {1, 0, 2, 3}, {1, 1, 1, 1}},
                                              {"x and y of PSD b exchanged", {0, 1, 3, 2}, {1, 1, 1, 1}},
                                              {"x of PSD a negative", {0, 1, 2, 3}, {-1, 1, 1, 1}},
                                              {"y of PSD a negative", {0, 1, 2, 3}, {1, -1, 1, 1}},
                                              {"x of PSD b negative", {0, 1, 2, 3}, {1, 1, -1, 1}},
                                              {"y of PSD b negative", {0, 1, 2, 3}, {1, 1, 1, -1}}}};

std::vector<Reading> Rewired(std::vector<Reading> readings, const Wiring& wiring) {
  for (Reading& r : readings) {
    const Reading shown = r;
    for (std::size_t c = 0; c < kChannels; ++c) {
      r.mean_V[c] = wiring.sign[c] * shown.mean_V[wiring.channel[c]];
      r.std_V[c] = shown.std_V[wiring.channel[c]];
    }
  }
  return readings;
}

/// What the fit leaves over the stated noise, all components together.
double PerU(const separate::Separation& s) {
  return std::sqrt(s.chi2.sum() / s.dof_of.sum());
}

/// What another wiring describes so much better is no scatter of the tables.
void AddMiswiring(const Scenario& scenario, const std::vector<Reading>& readings, const Analysis& analysis,
                  std::vector<report::Misfit>& misfits) {
  constexpr double kTimesBetter = 5.0;
  const double as_is = PerU(*analysis.separation);
  if (!(as_is > report::kMostMisfit)) return;
  for (const Wiring& wiring : kMiswired) {
    try {
      const Analysis other = Analyse(scenario, Rewired(readings, wiring), analysis.estimator);
      const double rewired = other.separation ? PerU(*other.separation) : as_is;
      if (kTimesBetter * rewired < as_is)
        misfits.push_back(
            {fmt::format("the separation, which leaves {:.2g} times with {},", rewired, wiring.what), as_is});
    } catch (const InputError&) {  // it is not so
    }
  }
}

report::ScoredRun ScoreOf(const Analysis& analysis, const nlohmann::json& truth) {
  if (!analysis.separation) throw InputError("the run", analysis.not_separated, "a run with a full-circle test");
  const Score score =
      CompareWithTruth(*analysis.separation, ErrorsOf(truth, "target"), ErrorsOf(truth, "reference"));
  std::string text = fmt::format("{} estimator against the truth; what is not separable is taken out of both\n",
                                 EstimatorName(analysis.estimator)) +
                     ScoreTable(score);
  for (const auto& lost : analysis.separation->not_separable) text += fmt::format("not separable: {}\n", lost.what);
  return {ToJson(score), text, PositionTable(score, *analysis.separation), ValuesOf(score)};
}

}  // namespace

report::Evaluation Evaluate(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator) {
  if (ShowsProbes(readings)) return EvaluateProbes(scenario, readings);
  const Analysis analysis = Analyse(scenario, readings, estimator);
  nlohmann::json results = ToJson(analysis);
  AddCalibrationParts(analysis, readings, scenario, results["calibration"]);
  if (analysis.separation) AddParts(analysis, readings, scenario, results["separation"]);
  const nlohmann::json separation = analysis.separation ? Agreed(results["separation"]) : nlohmann::json();
  report::Evaluation evaluation{results, separation, analysis.not_separated, Summary(analysis)};
  if (!analysis.separation) return evaluation;
  evaluation.joints = [separation = *analysis.separation] { return JointsOf(separation); };
  evaluation.misfits = MisfitsOf(*analysis.separation, analysis.calibration);
  AddMiswiring(scenario, readings, analysis, evaluation.misfits);
  evaluation.score = [analysis](const nlohmann::json& truth) { return ScoreOf(analysis, truth); };
  const report::ErrorMotionTexts motions = EvaluateErrorMotions(*analysis.separation, analysis.motions);
  evaluation.results["iso230_7"] = motions.json;
  evaluation.summary += motions.text;
  return evaluation;
}

report::ScoredRun ScoreRun(const Scenario& scenario, const std::vector<Reading>& readings,
                           const nlohmann::json& truth, Estimator estimator) {
  return ScoreOf(Analyse(scenario, readings, estimator), truth);
}

}  // namespace twinbench::benches::rotary
