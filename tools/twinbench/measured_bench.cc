#include "tools/twinbench/measure.h"

#include "hw_bridge/replay/replay_bench.h"
#include "tools/twinbench/stop_signal.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

namespace twinbench::tools {
namespace {

class OwnTwin : public hw::OpenBench {
 public:
  explicit OwnTwin(const Scenario& scenario) : twin_(scenario) {}
  RotaryBench Bench() override { return twin_.Bench(); }
  std::string Identity() const override { return "twin"; }

 private:
  sim::Twin twin_;
};

class Recording : public hw::OpenBench {
 public:
  explicit Recording(const std::string& folder) : replay_(folder), folder_(folder) {}
  RotaryBench Bench() override { return replay_.Bench(); }
  std::string Identity() const override { return "replay of " + folder_; }

 private:
  hw::ReplayBench replay_;
  std::string folder_;
};

}  // namespace

std::unique_ptr<hw::OpenBench> OpenAnyBench(const hw::BenchFile& file, const Scenario& scenario, Duration elapsed) {
  if (file.kind == "twin") return std::make_unique<OwnTwin>(scenario);
  if (file.kind == "replay") return std::make_unique<Recording>(file.record);
  const RotarySettings& own = RotaryOf(scenario);
  const double noise_V = scenario.noise_free ? 0.0 : own.amplifier.noise_V;
  return hw::OpenHardware(file, own.adc, noise_V, elapsed, scenario.repeat, StopWasAsked);
}

}  // namespace twinbench::tools
