#include "tools/twinbench/measure.h"

#include <fmt/core.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "hw_bridge/program/program_file.h"
#include "hw_bridge/program/program_run.h"
#include "hw_bridge/program/stops.h"
#include "tools/twinbench/evaluated_run.h"
#include "tools/twinbench/passing_run.h"
#include "tools/twinbench/stop_signal.h"
#include "twin/core/errors.h"

namespace twinbench::tools {
namespace {

namespace fs = std::filesystem;

std::string In(const RunFolder& folder, const std::string& file) {
  return fs::absolute(fs::path(folder.path) / file).string();
}

/// @return the run's readings, as the program wrote them.
hw::ReadStops RunOnce(const hw::ProgramFile& file, const Scenario& scenario, const RunFolder& folder) {
  const std::vector<Reading> planned = ReadingsOfTwin(scenario);
  const std::string asked = In(folder, "scenario.toml"), stops = In(folder, "stops.csv"),
                    readings = In(folder, "program_readings.csv");
  WriteFileAtOnce(asked, WriteScenario(scenario));
  hw::WriteStops(planned, scenario.bench, stops);
  fs::remove(readings);
  hw::RunProgram(file, {{"scenario", asked}, {"stops", stops}, {"readings", readings}}, StopWasAsked);
  return hw::ReadStopsBack(readings, planned, scenario.bench);
}

void Tell(const hw::ReadStops& back, std::size_t asked) {
  if (back.missing > 0)
    fmt::print(stderr, "twinbench: the program read {} of {} measuring positions\n", back.readings.size(), asked);
  if (back.extra > 0)
    fmt::print(stderr, "twinbench: {} row{} of no measuring position that was asked for, or of one that has a row, left out\n",
               back.extra, back.extra == 1 ? " is" : "s are");
}

}  // namespace

void MeasureByProgram(const MeasureOptions& options, const Scenario& scenario, LivePage& page, JsonAnswer& answer) {
  const hw::ProgramFile file = hw::LoadProgramFile(options.bench);
  if (options.rehearse_only) {
    const std::size_t planned = ReadingsOfTwin(scenario).size();
    fmt::print(stderr, "a program is not rehearsed: {} readings are planned\n", planned);
    return answer.Write({{"rehearsal", {{"readings", planned}}}});
  }
  const RunFolder folder = tools::FolderOf(options);
  const BegunRun begun = TakeUpIfAsked(options, scenario, folder);
  if (!begun.record || !begun.record->finished()) {
    fs::create_directories(folder.path);
    ListenForStop();
    const hw::ReadStops back = RunOnce(file, scenario, folder);
    Tell(back, back.readings.size() + static_cast<std::size_t>(back.missing));
    const std::string identity = "program: " + (file.name.empty() ? file.command.front() : file.name);
    const auto record = BeginRun(scenario, folder, "hardware", identity);
    page.Watch(*record, scenario, folder.path, false);
    record->AppendAll(back.readings);
    record->Finish();
  }
  EvaluateMeasured(scenario, folder.path, answer);
}

}  // namespace twinbench::tools
