#include <nlohmann/json.hpp>

#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/diagnosis/change_of_tables.h"
#include "twin/benches/rotary_4dof/diagnosis/conventions.h"
#include "twin/benches/rotary_4dof/diagnosis/rotary_case.h"
#include "twin/benches/rotary_4dof/diagnosis/rotary_run.h"
#include "twin/benches/rotary_4dof/diagnosis/search.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/factory.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/gain.h"

namespace twinbench::benches::rotary {
namespace {

diagnose::rotary::ForwardModel ModelOf(Estimator estimator) {
  return {FollowOften(), estimator == Estimator::kPublished};
}

std::vector<diagnose::Cause> Decided(const std::vector<diagnose::Discrete>& discrete) {
  std::vector<diagnose::Cause> causes;
  for (const auto& [effect, where, log_evidence] : discrete)
    causes.push_back(diagnose::DecidedCause(effect, where, log_evidence));
  return causes;
}

diagnose::AnswerWords Words(const diagnose::rotary::RotaryCase& rotary) {
  return {[design = rotary.Rotary().design](const std::string&, const Eigen::VectorXd& x) {
            return diagnose::rotary::BiasInWords(design, x);
          },
          NextMeasurement};
}

}  // namespace

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& as_read, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options) {
  const diagnose::rotary::ForwardModel model = ModelOf(options.model);
  diagnose::rotary::ConventionResult convention{"", 0.0, as_read};
  if (!diagnose::IsExcluded(options, "convention"))
    convention = diagnose::rotary::ScreenConventions(as_read, scenario, model);
  diagnose::SearchedRotary searched = diagnose::SearchRotary(convention.readings, scenario, options, model);
  if (!convention.where.empty())
    searched.discrete.insert(searched.discrete.begin(), {"convention", convention.where, convention.log_evidence});
  const diagnose::rotary::RotaryCase& rotary = *searched.rotary;
  diagnose::DiagnosisRun result =
      diagnose::Conclude(rotary.Rotary().run, searched.analysis, Decided(searched.discrete), Words(rotary));
  for (const char* where : {"reverse_target", "reverse_reference", "index_offset"}) {
    result.diagnosis.invisible.push_back(
        {"convention", where, "the positions that the separated errors belong to"});
  }
  result.diagnosis.left_out = rotary.Rotary().left_out;
  return result;
}

diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator estimator) {
  return diagnose::rotary::BuildRun(readings, scenario, ModelOf(estimator)).run;
}

nlohmann::json ChangeOfTables(const diagnose::DiagnosisRun& found, const Scenario& scenario) {
  return diagnose::rotary::ToJson(diagnose::rotary::ChangeOfTables(found.run, found.noise, found.accepted,
                                                                   RotaryOf(scenario).procedure.positions));
}

}  // namespace twinbench::benches::rotary
