#include "tools/twinbench/measured_bench.h"

#include "hw_bridge/open_bench.h"
#include "hw_bridge/replay/replay_bench.h"
#include "twin/sim/twin.h"

namespace twinbench::tools {
namespace {

class ProgramsOwnTwin : public MeasuredBench {
 public:
  explicit ProgramsOwnTwin(const Scenario& scenario) : twin_(scenario) {}
  RotaryBench Bench() override { return twin_.Bench(); }
  std::string Identity() const override { return "twin"; }

 private:
  sim::Twin twin_;
};

class Recording : public MeasuredBench {
 public:
  explicit Recording(const std::string& folder) : replay_(folder), folder_(folder) {}
  RotaryBench Bench() override { return replay_.Bench(); }
  std::string Identity() const override { return "replay of " + folder_; }

 private:
  hw::ReplayBench replay_;
  std::string folder_;
};

class Hardware : public MeasuredBench {
 public:
  Hardware(const hw::BenchFile& file, const Scenario& scenario, Duration elapsed)
      : bench_(hw::OpenBench(file, scenario, elapsed)) {}
  RotaryBench Bench() override { return bench_->Bench(); }
  std::string Identity() const override { return bench_->Identity(); }
  std::vector<std::string> Configuration() const override { return bench_->Configuration(); }
  std::vector<std::string> Notices() const override { return bench_->Notices(); }

 private:
  std::unique_ptr<hw::HardwareBench> bench_;
};

}  // namespace

std::unique_ptr<MeasuredBench> OpenMeasuredBench(const hw::BenchFile& file, const Scenario& scenario,
                                                 Duration elapsed) {
  if (file.kind == "twin") return std::make_unique<ProgramsOwnTwin>(scenario);
  if (file.kind == "replay") return std::make_unique<Recording>(file.record);
  return std::make_unique<Hardware>(file, scenario, elapsed);
}

}  // namespace twinbench::tools
