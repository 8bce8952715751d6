#include "tools/twinbench/twin_run.h"

#include <filesystem>

#include "tools/twinbench/progress.h"
#include "twin/core/errors.h"
#include "twin/core/run_record.h"
#include "twin/procedure/angle_comparison.h"
#include "twin/procedure/hob.h"
#include "twin/procedure/procedure.h"
#include "twin/procedure/turntable.h"
#include "twin/sim/encoder/twin.h"
#include "twin/sim/hob/twin.h"
#include "twin/sim/turntable/twin.h"
#include "twin/sim/twin.h"

namespace twinbench::tools {
namespace {

/// Makes the folder of a run of the twin, with an empty record.
std::unique_ptr<RunRecord> Begin(const Scenario& scenario, const RunFolder& folder, const nlohmann::json& truth) {
  auto record = RunRecord::Create(folder.path, {TWINBENCH_VERSION, "twin", scenario.seed, ""});
  WriteFileAtOnce(folder.scenario(), WriteScenario(scenario));
  WriteJson(folder.truth(), truth);
  return record;
}

void RunRotary(const Scenario& scenario, const RunFolder& folder, bool images) {
  sim::Twin twin(scenario);
  const auto record = Begin(scenario, folder, ToJson(twin.TheTruth()));
  RotaryBench bench = twin.Bench();
  ProgressLine progress;
  procedure::Options options;
  options.log = record.get();
  procedure::CarryOut(bench, scenario, *record, ShownOn(progress), options);
  record->Finish();
  if (!images) return;
  std::filesystem::create_directories(folder.images());
  twin.WriteIrradiance(folder.images() + "/irradiance.exr");
}

void RunEncoder(const Scenario& scenario, const RunFolder& folder) {
  sim::EncoderTwin twin(scenario);
  const auto record = Begin(scenario, folder, twin.Truth());
  ProgressLine progress;
  procedure::CarryOut(twin, scenario, *record, ShownOn(progress));
  record->Finish();
}

template <class Twin>
void RunBench(const Scenario& scenario, const RunFolder& folder) {
  Twin twin(scenario);
  const auto record = Begin(scenario, folder, twin.Truth());
  auto bench = twin.Bench();
  ProgressLine progress;
  procedure::CarryOut(bench, scenario, *record, ShownOn(progress));
  record->Finish();
}

}  // namespace

void RunOnTwin(const Scenario& scenario, const RunFolder& folder, bool images) {
  if (scenario.bench == kRotaryBench) return RunRotary(scenario, folder, images);
  if (images)
    throw InputError("--images", "the bench " + scenario.bench + " has no light on PSDs", "a run without images");
  if (scenario.bench == kEncoderBench) return RunEncoder(scenario, folder);
  if (scenario.bench == kTurntableBench) return RunBench<sim::TurntableTwin>(scenario, folder);
  RunBench<sim::HobTwin>(scenario, folder);
}

}  // namespace twinbench::tools
