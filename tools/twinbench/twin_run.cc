#include "tools/twinbench/twin_run.h"

#include <fmt/format.h>

#include <filesystem>

#include "tools/twinbench/progress.h"
#include "tools/twinbench/stop_signal.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/run_record.h"

namespace twinbench::tools {
namespace {

/// Nothing but the twin moves here, and what is made of it can be made again.
procedure::ProgressCallback UnlessStopped(procedure::ProgressCallback shown) {
  return [shown](const procedure::Progress& p) {
    shown(p);
    if (StopWasAsked())
      throw BenchError(fmt::format("stopped by the operator behind reading {} of {}; nothing but the twin has moved",
                                   p.readings_done, p.readings_planned));
  };
}

}  // namespace

void RunOnTwin(const Scenario& scenario, const RunFolder& folder, bool images, LivePage& page) {
  const Bench& bench = BenchOf(scenario);
  RequireRoomFor(folder, scenario);
  if (images && !bench.is_pictured)
    throw InputError("--images", "the bench " + scenario.bench + " has no light on PSDs", "a run without images");
  const std::unique_ptr<BenchTwin> twin = bench.make_twin(scenario);
  const auto record =
      RunRecord::Create(folder.path, {TWINBENCH_VERSION, "twin", scenario.seed, "", scenario.bench});
  record->WriteBeside(kScenarioFile, WriteScenario(scenario));
  record->WriteBeside(kTruthFile, JsonText(twin->Truth()));
  record->SpareTheDisk();
  ProgressLine progress;
  page.Watch(*record, scenario, folder.path);
  twin->CarryOut(*record, UnlessStopped(page.ShownToo(ShownOn(progress))), record.get());
  record->Finish();
  if (!images) return;
  std::filesystem::create_directories(folder.images());
  twin->WriteImages(folder.images());
}

}  // namespace twinbench::tools
