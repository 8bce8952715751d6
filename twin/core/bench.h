#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/core/bench_format.h"

namespace twinbench {

class RunLog;
class MachineDevices;
class ReadingSink;
struct MachineBench;
enum class Estimator;
namespace model {
class Follow;
}
namespace separate {
struct IndexErrors;
}
namespace uncertainty {
struct Contribution;
}
namespace plausible {
struct Plan;
}
namespace plan {
struct NextRun;
struct ShiftDesign;
}
namespace report {
struct Evaluation;
struct ScoredRun;
}  // namespace report
namespace diagnose {
struct DiagnoseOptions;
struct DiagnosisRun;
struct LinearRun;
}  // namespace diagnose
namespace procedure {
struct Progress;
struct MachineOptions;
}  // namespace procedure

/// A scenario's bench as the simulation has it, ready for one run.
class BenchTwin {
 public:
  virtual ~BenchTwin() = default;
  /// truth.json.
  virtual nlohmann::json Truth() const = 0;
  /// Carries the scenario's procedure out.
  /// @param log  Keeps what is asked of the devices, where the procedure writes it down; none: nobody does.
  virtual void CarryOut(ReadingSink& readings, const std::function<void(const procedure::Progress&)>& progress,
                        RunLog* log = nullptr) = 0;
  /// Writes the light as the run has left it into an existing folder; only where the bench can be pictured.
  virtual void WriteImages(const std::string& /*folder*/) {}
};

/// A bench, whole: all that the rest of the program does with it. Each is described once, in its folder of
/// twin/benches, and found by its name in twin/benches/registry.h. What the functions take and return belongs to
/// the rooms that make it; this header knows the names of those types only.
struct Bench {
  const BenchFormat* format = nullptr;  // never null

  std::unique_ptr<BenchTwin> (*make_twin)(const Scenario&) = nullptr;
  /// The twin on the course of a record. Throws InputError if its parts cannot be built.
  std::unique_ptr<model::Follow> (*follow)(const Scenario&, const std::vector<Reading>& record) = nullptr;
  int (*planned_readings)(const Scenario&) = nullptr;  // of the whole run
  /// What the procedure says of readings that are said to be its own, before they are used. Null: nothing.
  plausible::Plan (*plan)(const Scenario&, const std::vector<Reading>&) = nullptr;
  bool is_pictured = false;                            // there is light on detectors, which `run --images` writes
  bool has_controllers = false;                        // real devices can stand for it: `measure` and `serve`

  /// Of a bench that is driven as a MachineBench: its twin as devices, and the procedure on any such bench. Null of
  /// others.
  std::unique_ptr<MachineDevices> (*make_devices)(const Scenario&) = nullptr;
  void (*drive)(MachineBench&, const Scenario&, ReadingSink&,
                const std::function<void(const procedure::Progress&)>&, const procedure::MachineOptions&) = nullptr;

  /// Readings -> results.json, separation.json and a summary.
  report::Evaluation (*evaluate)(const Scenario&, const std::vector<Reading>&, Estimator) = nullptr;
  /// A run of the twin against its truth.json. Throws InputError if there is nothing to compare.
  report::ScoredRun (*score)(const Scenario&, const std::vector<Reading>&, const nlohmann::json& truth,
                             Estimator) = nullptr;

  /// The index errors of the table that a compensation can be commanded to, where they were read. Null: the bench
  /// has no such table. Throws InputError if the readings show none.
  separate::IndexErrors (*index_errors)(const Scenario&, const std::vector<Reading>&) = nullptr;

  /// What moves and scatters the twin's readings, each with a way to still it.
  std::vector<uncertainty::Contribution> (*contributions)(const Scenario&) = nullptr;

  /// The shifts that a comparison of two tables is planned by. Null: nothing is shifted.
  plan::ShiftDesign (*shift_design)(const Scenario&) = nullptr;

  /// Runs that could be made next, beside the same once more. Null: no others.
  std::vector<plan::NextRun> (*next_runs)(const Scenario&) = nullptr;

  diagnose::DiagnosisRun (*diagnose)(const std::vector<Reading>&, const Scenario&,
                                     const diagnose::DiagnoseOptions&) = nullptr;
  /// The readings so far, to be watched while more come. Throws InputError if they are too few.
  diagnose::LinearRun (*linear_run)(const std::vector<Reading>&, const Scenario&, Estimator) = nullptr;
  /// `gain.change_of_tables` of diagnosis.json; null: the bench has no such thing to say.
  nlohmann::json (*change_of_tables)(const diagnose::DiagnosisRun&, const Scenario&) = nullptr;
};

}  // namespace twinbench
