#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/twinbench/run_folder.h"
#include "twin/report/evaluation.h"
#include "twin/separate/compensation.h"
#include "twin/uncertainty/monte_carlo.h"

/// What commands make of runs, scenarios and recordings, for other programs too.
namespace twinbench::tools {

struct Answer {
  nlohmann::json json;  // as `--json`
  std::string text;     // as printed
};

/// `twinbench uncertainty`.
/// @param source    The run's place, for messages.
/// @param trials    Of Supplement 1; null: none.
/// @throws InputError if no result has an uncertainty.
Answer UncertaintyOf(const RecordedRun& run, const std::string& source, const std::string& estimator,
                     const uncertainty::MonteCarloOptions* trials);

/// `twinbench budget`: simulates the scenario, and again with one source after the other switched off.
/// @param figures  Their place in results.json: "stability.range".
/// @param between  Called before each simulation; what it throws ends them.
/// @throws InputError if the bench lists no sources, or there is no number at that place.
Answer BudgetOf(const Scenario& scenario, const std::string& source, const std::string& figures,
                const std::function<void()>& between = {});

struct CompensationWish {
  std::string form = "plain", axis = "C";
  separate::CompensationOptions how;
};
struct CompensationMade : Answer {
  std::string table;  // in the wanted form
};

/// `twinbench compensate`.
/// @param check  A run with the table at work; null: none.
/// @throws InputError if the bench has no table that could be compensated.
CompensationMade CompensationOf(const RecordedRun& run, const std::string& source, const CompensationWish& wish,
                                const RecordedRun* check = nullptr, const std::string& check_source = "");

/// `twinbench certificate`.
/// @param laboratory  What the TOML file says; its name is for messages.
/// @return the XML as text.
/// @throws InputError if the run is not finished, or nothing of it can be certified.
Answer CertificateOf(const std::string& run, const std::string& laboratory, const std::string& laboratory_file);

/// The page of `twinbench report`, into a file that is free or a page.
/// @param score  As of PageOf.
void WriteReport(const std::string& source, const std::string& score, const std::string& output);

/// What `score --json` writes: with every number beside its truth.
nlohmann::json ScoreJson(const report::ScoredRun& score);

/// Recordings, and what is said of them.
struct ImportWish {
  std::vector<std::string> files;
  std::string scenario, map;
  std::vector<std::string> overrides, columns;
  int most_readings = 0;
  int axis_number = 0;
};
struct Imported : RecordedRun {
  std::string story;  // how they were understood; empty of a readings.csv
};

/// `twinbench import` before anything is written.
Imported ImportedFrom(const ImportWish& wish);

}  // namespace twinbench::tools
