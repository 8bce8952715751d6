#include "tools/twinbench/twin_run.h"

#include <filesystem>

#include "tools/twinbench/progress.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/run_record.h"

namespace twinbench::tools {

void RunOnTwin(const Scenario& scenario, const RunFolder& folder, bool images) {
  const Bench& bench = BenchOf(scenario);
  RequireRoomFor(folder, scenario);
  if (images && !bench.is_pictured)
    throw InputError("--images", "the bench " + scenario.bench + " has no light on PSDs", "a run without images");
  const std::unique_ptr<BenchTwin> twin = bench.make_twin(scenario);
  const auto record =
      RunRecord::Create(folder.path, {TWINBENCH_VERSION, "twin", scenario.seed, "", scenario.bench});
  record->SpareTheDisk();
  WriteFileAtOnce(folder.scenario(), WriteScenario(scenario));
  WriteJson(folder.truth(), twin->Truth());
  ProgressLine progress;
  twin->CarryOut(*record, ShownOn(progress));
  record->Finish();
  if (!images) return;
  std::filesystem::create_directories(folder.images());
  twin->WriteImages(folder.images());
}

}  // namespace twinbench::tools
