#include "twin/benches/hob_transmission/bench.h"
#include "twin/benches/hob_transmission/diagnosis/families.h"
#include "twin/benches/hob_transmission/diagnosis/hob_answers.h"
#include "twin/benches/hob_transmission/diagnosis/hob_run.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/hob_transmission/twin/factory.h"
#include "twin/diagnose/conclusion.h"

namespace twinbench::benches::hob {

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options) {
  const diagnose::hob::HobRun hob = diagnose::hob::BuildRun(readings, scenario, FollowRecord);
  const std::vector<diagnose::Family> families = diagnose::hob::Families(hob, options.excluded);
  diagnose::AnalysisOptions how = diagnose::AnalysisOptionsOf(options);
  how.null_runs = diagnose::hob::NullRuns(hob, options.null_runs);
  how.most_causes = 6;
  const diagnose::Analysis analysis = diagnose::hob::AnalyseToFirstOrder(hob, families, how);
  const diagnose::AnswerWords words{
      [orders = HobOf(scenario).transmission.free_orders](const std::string&, const Eigen::VectorXd& x) {
        return diagnose::hob::BiasInWords(orders, x);
      },
      NextMeasurement};
  diagnose::DiagnosisRun result =
      diagnose::Conclude(hob.run, analysis, diagnose::hob::OutlierCauses(hob, options.excluded), words);
  diagnose::hob::ToReadings(hob, result);
  return result;
}

diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator) {
  return diagnose::hob::BuildRun(readings, scenario, FollowRecord).run;
}

}  // namespace twinbench::benches::hob
