#include "hw_bridge/replay/replay_bench.h"
#include "tests/contract/rotary_bench.h"
#include "tests/core/input_error.h"
#include "tests/support/served_run.h"

namespace twinbench::test {
namespace {

class LivingTwin : public LivingBench {
 public:
  explicit LivingTwin(const Scenario& scenario) : twin_(scenario) {}
  RotaryBench Bench() override { return twin_.Bench(); }

 private:
  sim::Twin twin_;
};

BenchBackend TwinOf(const std::string& fidelity) {
  const auto make = [fidelity](Scenario scenario) -> std::unique_ptr<LivingBench> {
    RotaryOf(scenario).mechanics.fidelity = fidelity;
    return std::make_unique<LivingTwin>(scenario);
  };
  return {"Twin" + fidelity, make, true};
}

/// A served twin, reached as a real bench is.
class LivingHardware : public LivingBench {
 public:
  LivingHardware(const Scenario& scenario, const RunOptions& options) : served_(scenario) {
    opened_ = test::OpenHardware(BenchFileOf(served_, options), scenario);
    opened_->Bench().simulation->Restart();  // its time ran until now
  }
  RotaryBench Bench() override { return opened_->Bench(); }

 private:
  ServedTwin served_;
  std::unique_ptr<hw::OpenBench> opened_;
};

BenchBackend HardwareBy(const std::string& converter, const std::string& tables) {
  RunOptions options;
  options.converter = converter;
  options.tables = tables;
  const auto make = [options](const Scenario& scenario) -> std::unique_ptr<LivingBench> {
    return std::make_unique<LivingHardware>(scenario, options);
  };
  return {converter + "And" + tables, make, true, true, converter == "comedi" ? MissingComedi() : ""};
}

/// Whatever is asked of it is recorded, and asked again of the recording at the end: that must answer the same.
class RecordedAndReplayed : public LivingBench {
 public:
  explicit RecordedAndReplayed(const Scenario& scenario)
      : twin_(scenario),
        devices_(twin_.Bench()),
        record_(RunRecord::Create(folder_.path(), {"test", "twin", scenario.seed, "", kRotaryBench})),
        asked_([this](const std::string& device, const std::string& request) { return Ask(device, request); },
               [this] { return devices_.clock.Now(); }, nullptr) {}
  ~RecordedAndReplayed() override {
    if (asked_calls_.empty()) return;
    record_->Finish();
    record_.reset();
    hw::ReplayBench replay(folder_.path());
    RotaryBench bench = replay.Bench();
    for (const auto& [call, raw] : asked_calls_) {
      const CallAnswer answer = Perform(bench, call.device, call.request);
      EXPECT_EQ(answer.text, call.answer) << call.device << ": " << call.request;
      EXPECT_EQ(answer.block.raw, raw);
      EXPECT_EQ(bench.clock.Now(), call.time);
    }
    EXPECT_THROW(bench.thermometer.Read_degC(), BenchError) << "the recording has ended";
  }
  RotaryBench Bench() override { return asked_.Bench(); }

 private:
  CallAnswer Ask(const std::string& device, const std::string& request) {
    CallAnswer answer = Perform(devices_, device, request);
    const DeviceCall call{devices_.clock.Now(), device, request, answer.text};
    asked_calls_.emplace_back(call, answer.block.raw);
    record_->Called(call);
    if (device == "adc") Keep(answer.block);
    return answer;
  }
  void Keep(const Acquisition& block) {
    Reading reading;
    reading.reading = readings_++;
    reading.time = block.start;
    record_->Append(reading, block);
  }

  TemporaryFolder folder_;
  sim::Twin twin_;
  RotaryBench devices_;
  std::unique_ptr<RunRecord> record_;
  AskedBench asked_;
  std::vector<std::pair<DeviceCall, std::vector<std::int16_t>>> asked_calls_;
  int readings_ = 0;
};

}  // namespace

std::vector<BenchBackend> Backends() {
  const auto recorded = [](const Scenario& scenario) -> std::unique_ptr<LivingBench> {
    return std::make_unique<RecordedAndReplayed>(scenario);
  };
  return {TwinOf("kinematic"),
          TwinOf("linear"),
          TwinOf("bullet"),
          HardwareBy("iio", "scpi"),
          HardwareBy("iio", "esp"),
          HardwareBy("iio", "pty"),
          HardwareBy("comedi", "scpi"),
          BenchBackend{"Replay", recorded, true},
          PythonBackend()};
}

}  // namespace twinbench::test
