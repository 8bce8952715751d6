#include "twin/benches/encoder_comparison/bench.h"
#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"
#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/benches/encoder_comparison/diagnosis/harmonic_table.h"
#include "twin/benches/encoder_comparison/twin/factory.h"
#include "twin/diagnose/conclusion.h"

namespace twinbench::benches::encoder {

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options) {
  const diagnose::encoder::EncoderRun encoder = diagnose::encoder::BuildRun(readings, scenario, FollowRecord);
  const std::vector<diagnose::Family> families = diagnose::encoder::Families(encoder, options.excluded);
  diagnose::AnalysisOptions how = diagnose::AnalysisOptionsOf(options);
  how.most_causes = 8;  // an angle device may well have an error of many orders
  const diagnose::Analysis analysis = diagnose::Analyse(encoder.run, families, how);
  const diagnose::AnswerWords words{
      [](const std::string&, const Eigen::VectorXd&) { return std::string("nothing but the device's offset"); },
      NextMeasurement};
  diagnose::DiagnosisRun result = diagnose::Conclude(encoder.run, analysis, {}, words);
  result.diagnosis.left_out = encoder.left_out;
  result.diagnosis.harmonics = diagnose::encoder::HarmonicTable(encoder, analysis.noise);
  return result;
}

diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator) {
  return diagnose::encoder::BuildRun(readings, scenario, FollowRecord).run;
}

}  // namespace twinbench::benches::encoder
