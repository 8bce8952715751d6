#include "tools/twinbench/investigated_bench.h"

#include <filesystem>
#include <system_error>

#include "tools/twinbench/measure.h"
#include "tools/twinbench/run_folder.h"
#include "tools/twinbench/twin_run.h"
#include "twin/core/errors.h"
#include "twin/core/run_record.h"
#include "twin/investigate/hidden_run.h"

namespace twinbench::tools {
namespace {

namespace fs = std::filesystem;

RunFolder FolderIn(const std::string& folder, const investigate::Step& step) {
  return {folder + "/" + investigate::FolderOf(step)};
}

/// A run that is there whole. @throws InputError if it is another scenario's.
bool IsFinished(const RunFolder& run, const Scenario& asked) {
  if (!fs::exists(run.record()) || !fs::exists(run.scenario())) return false;
  if (WriteScenario(LoadScenario(run.scenario())) != WriteScenario(asked))
    throw InputError(run.path, "holds a run of another scenario", "the folder of this investigation, or a new one");
  return RunRecord::Open(run.path)->finished();
}

class HiddenTwin : public InvestigatedBench {
 public:
  HiddenTwin(const std::string& hidden, const Scenario& believed, const std::string& folder, LivePage& page)
      : hidden_(LoadScenario(hidden)), believed_(believed), folder_(folder), page_(page) {}

  std::vector<Reading> Measure(const investigate::Step& step, const Scenario& asked) override {
    const RunFolder run = FolderIn(folder_, step);
    if (!IsFinished(run, asked)) MakeAnew(run, step, asked);
    return RunRecord::Open(run.path)->Readings();
  }
  bool CanMakeAlone(const plan::NextRun&) const override { return true; }

 private:
  /// What was begun is made again: a twin gives the same bits.
  void MakeAnew(const RunFolder& run, const investigate::Step& step, const Scenario& asked) {
    std::error_code ignored;
    fs::remove_all(run.path, ignored);
    RunOnTwin(investigate::HiddenRun(hidden_, believed_, step.run, asked.repeat), run, false, page_);
    RunRecord::Open(run.path)->WriteBeside(kScenarioFile, WriteScenario(asked));  // what is believed; the rest is in truth.json
  }

  Scenario hidden_, believed_;
  std::string folder_;
  LivePage& page_;
};

class MeasuredBench : public InvestigatedBench {
 public:
  MeasuredBench(const std::string& bench_file, const std::string& folder, LivePage& page)
      : bench_(bench_file), folder_(folder), page_(page) {}

  std::vector<Reading> Measure(const investigate::Step& step, const Scenario& asked) override {
    const RunFolder run = FolderIn(folder_, step);
    if (!IsFinished(run, asked)) {
      fs::create_directories(folder_);
      const std::string scenario = run.path + ".toml";
      WriteFileAtOnce(scenario, WriteScenario(asked));
      MeasureOptions options;
      options.scenario = scenario;
      options.bench = bench_;
      options.folder = run.path;
      options.resume = fs::exists(run.record());
      options.rehearse = true;
      JsonAnswer nobody_asks;
      tools::Measure(options, page_, nobody_asks);
    }
    return RunRecord::Open(run.path)->Readings();
  }
  bool CanMakeAlone(const plan::NextRun& run) const override { return investigate::IsProcedureAlone(run); }

 private:
  std::string bench_, folder_;
  LivePage& page_;
};

}  // namespace

std::unique_ptr<InvestigatedBench> OpenHiddenTwin(const std::string& hidden, const Scenario& believed,
                                                  const std::string& folder, LivePage& page) {
  return std::make_unique<HiddenTwin>(hidden, believed, folder, page);
}

std::unique_ptr<InvestigatedBench> OpenMeasuredBench(const std::string& bench_file, const std::string& folder,
                                                     LivePage& page) {
  return std::make_unique<MeasuredBench>(bench_file, folder, page);
}

}  // namespace twinbench::tools
