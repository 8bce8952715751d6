#pragma once

#include "hw_bridge/ad/ad_converter.h"
#include "tests/hw_ad/blocks.h"
#include "tests/support/faults.h"
#include "tests/support/served_twin.h"

/// A served twin whose time a client holds, and that client's clock.
namespace twinbench::test {

class HeldTwin : public Clock {
 public:
  /// @param iiod_port  0: any that is free.
  explicit HeldTwin(const Scenario& scenario, int iiod_port = 0) : served_(At(iiod_port), scenario) {
    Ask("CLOC:HOLD ON;:SIM:PACE OFF;:SIM:REST;*OPC?");
  }

  int iiod_port() const { return served_.at().iiod_port; }
  std::string Ask(const std::string& line) const { return scpi_.Ask(line); }
  /// The next block suffers `kind`.
  void Inject(const std::string& kind) const { Ask("SIM:FAUL adc," + kind + ",1;*OPC?"); }

  Time Now() const override { return Time(Duration(std::stoll(Ask("CLOC:NOW?")))); }
  void Wait(Duration duration) override { Ask("CLOC:WAIT? " + std::to_string(duration.count()) + ";*OPC?"); }

 private:
  static hw::ServeOptions At(int iiod_port) {
    hw::ServeOptions options = OnFreePorts(1.0);
    options.iiod_port = iiod_port;
    options.pty = false;
    return options;
  }

  ServedTwin served_;
  mutable TcpClient scpi_{served_.at().scpi_port};
};

/// The kind of fault that a call ends in; "none".
template <class Call>
std::string FaultIn(const Call& call) {
  const std::optional<FaultKind> kind = KindOf(call);
  return kind ? FaultName(*kind) : "none";
}

inline std::string IiodAddress(const HeldTwin& served) { return "127.0.0.1:" + std::to_string(served.iiod_port()); }

inline hw::AdSettings IioSettings(const HeldTwin& served) {
  return {.kind = "iio",
          .uri = "ip:" + IiodAddress(served),
          .device = "psd-adc16",
          .channels = {"voltage0", "voltage1", "voltage2", "voltage3"},
          .light = "light",
          .serial = {},
          .calibration_file = {},
          .timeout_s = 0.5};
}

inline hw::AdSettings ComediSettings(const HeldTwin& served) {
  setenv("TWINBENCH_COMEDI_TWIN", IiodAddress(served).c_str(), 1);
  return {.kind = "comedi",
          .device = "/dev/comedi0",
          .channels = {"0", "1", "2", "3"},
          .light = "1",
          .serial = {},
          .calibration_file = {},
          .timeout_s = 0.5};
}

inline double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Fault kind as it is injected into the served twin and as it is told.
struct Struck {
  const char *injected, *fault;
  static std::string Name(const ::testing::TestParamInfo<Struck>& tested) { return tested.param.injected; }
};

/// A served twin whose converter is opened through a backend.
struct ServedCard {
  explicit ServedCard(hw::AdSettings (*settings_of)(const HeldTwin&),
                      const Scenario& its_scenario = RotaryScenario())
      : scenario(its_scenario), served(scenario), settings(settings_of(served)) {}

  std::unique_ptr<hw::AdFrontEnd> Open() const { return OpenWith(settings); }
  std::unique_ptr<hw::AdFrontEnd> OpenWith(const hw::AdSettings& other) const {
    return hw::MakeAdConverter(other, RotaryOf(scenario).adc, served, RotaryOf(scenario).amplifier.noise_V);
  }

  /// The same acquisitions, at the same bench times, on a twin in this process.
  void ExpectTheTwinsOwnBlocks() {
    const auto card = Open();
    sim::Twin twin(scenario);
    RotaryBench bench = twin.Bench();
    for (const int scans : {100, 1, 2, 1000, 20000}) {
      ExpectSameBlock(card->Acquire(scans, true), bench.adc.Acquire(scans, true));
      bench.clock.Wait(std::chrono::milliseconds(1234));
      served.Wait(std::chrono::milliseconds(1234));
    }
  }

  /// A fault has its name in time, and the blocks behind it are as good as any: of the second, the clocks too.
  void ExpectNamedAndTheNextBlocksWhole(const Struck& struck) {
    const auto card = Open();
    served.Ask("GON:MOVE 150,80;*OPC?");
    card->Acquire(100, true);
    for (int round = 0; round < 2; ++round) {
      served.Inject(struck.injected);
      const auto start = std::chrono::steady_clock::now();
      EXPECT_EQ(FaultIn([&] { card->Acquire(200, true); }), struck.fault);
      EXPECT_LT(SecondsSince(start), 1.0) << "our deadline is 0.5 s; libiio's would be 5 or 10 s";
      for (int k = 0; k < 2; ++k) {
        const Acquisition after = card->Acquire(200, true);
        EXPECT_EQ(after.status, ReadingStatus::kOk);
        EXPECT_EQ(after.raw.size(), 800u);
      }
    }
  }

  /// The fault in which opening it and a block end with settings that were changed.
  std::string FaultWith(const std::function<void(hw::AdSettings&)>& change) const {
    hw::AdSettings changed = settings;
    change(changed);
    return FaultIn([&] { OpenWith(changed)->Acquire(10, true); });
  }

  Scenario scenario;
  HeldTwin served;
  hw::AdSettings settings;
};

}  // namespace twinbench::test
