#include "tests/investigate/hidden_investigation.h"

#include <filesystem>
#include <fstream>

#include "hw_bridge/program/program_run.h"
#include "hw_bridge/program/stops.h"
#include "tools/twinbench/passing_run.h"

namespace twinbench::investigate {
namespace {

constexpr const char* kUnlisted = "unlisted";

/// Sweeps are read every half second: a run of the list has some hundred readings and not thousands.
Scenario BelievedEncoder() {
  return ParseScenario(
      "bench = \"encoder_comparison\"\nseed = 3\n[device]\nnoise_deg = 0.002\n[encoder_procedure]\n"
      "stops_per_turn = 36\nturns = 2.0\npasses = [1, -1]\ninterval_s = 0.5\n",
      "believed.toml", ".");
}

/// One run: what `measure` and `investigate` do with a bench of kind "program".
std::vector<Reading> RunOf(const std::string& script, std::uint64_t seed, const std::string& folder,
                           const Scenario& asked) {
  const std::string scenario = folder + "/scenario.toml", stops = folder + "/stops.csv",
                    readings = folder + "/readings.csv";
  std::ofstream(scenario) << WriteScenario(asked);
  const std::vector<Reading> planned = tools::ReadingsOfTwin(asked);
  hw::WriteStops(planned, asked.bench, stops);
  hw::ProgramFile file;
  file.path = folder + "/bench.toml";
  file.command = {"python3", script, "{scenario}", "{stops}", "{readings}", std::to_string(seed)};
  hw::RunProgram(file, {{"scenario", scenario}, {"stops", stops}, {"readings", readings}}, [] { return false; });
  return hw::ReadStopsBack(readings, planned, asked.bench).readings;
}

Truth TruthIn(const std::string& folder) {
  Truth truth;
  std::ifstream in(folder + "/truth.txt");
  std::getline(in, truth.effect);
  std::getline(in, truth.words);
  if (truth.effect == kUnlisted) truth.effect.clear();
  return truth;
}

}  // namespace

Judged InvestigateProgram(const std::string& script, std::uint64_t seed, const std::string& folder) {
  std::filesystem::create_directories(folder);
  const Scenario believed = BelievedEncoder();
  RunOf(script, seed, folder, believed);
  InvestigationOptions options;
  options.budget_min = 600.0;
  const auto measure = [&](const Step&, const Scenario& asked) { return RunOf(script, seed, folder, asked); };
  return InvestigateBench(believed, TruthIn(folder), measure, options);
}

}  // namespace twinbench::investigate
