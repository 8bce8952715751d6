#pragma once

#include <thread>

#include "hw_bridge/open_bench.h"
#include "hw_bridge/serve/server.h"
#include "tests/support/memory_log.h"
#include "tests/support/rotary_scenario.h"
#include "tests/support/sanitized.h"
#include "tests/support/tcp_client.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

namespace twinbench::test {

/// An answer is awaited for so long: many times what a busy machine needs. One that comes late is twice as late.
inline constexpr double kForAnAnswer_s = kSanitized ? 1.5 : 0.5;

/// On free ports of this machine.
inline hw::ServeOptions OnFreePorts(double speed = std::numeric_limits<double>::infinity()) {
  hw::ServeOptions options;
  options.iiod_port = options.scpi_port = options.esp_port = 0;
  options.speed = speed;
  options.late = FromSeconds(2.0 * kForAnAnswer_s);
  return options;
}

/// The bench of a file with the converter that the scenario has.
inline std::unique_ptr<hw::OpenBench> OpenHardware(const hw::BenchFile& file, const Scenario& scenario) {
  const RotarySettings& own = RotaryOf(scenario);
  return hw::OpenHardware(file, own.adc, scenario.noise_free ? 0.0 : own.amplifier.noise_V);
}

/// A server that runs on a thread of its own, until this goes.
class RunningServer {
 public:
  template <class... Shown>
  explicit RunningServer(const Shown&... shown) : server_(shown...), thread_([this] { server_.Run(); }) {}
  ~RunningServer() {
    server_.Stop();
    thread_.join();
  }
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;

  hw::ServedAddresses at() const { return server_.Addresses(); }
  std::string ScpiAddress() const { return "tcp:" + at().host + ":" + std::to_string(at().scpi_port); }
  /// One answer of its SCPI port.
  std::string Ask(const std::string& line) const { return TcpClient(at().scpi_port).Ask(line); }
  /// Asks it to suffer: "adc,drop", "target,lost_step,2".
  void Inject(const std::string& fault) const {
    const std::string answer = Ask("SIM:FAUL " + fault + ";SYST:ERR?");
    if (!answer.starts_with("0,")) throw BenchError("fault " + fault + ": " + answer);
  }

 private:
  hw::Server server_;
  std::thread thread_;
};

class ServedTwin : sim::Twin, public RunningServer {
 public:
  explicit ServedTwin(const hw::ServeOptions& options, const Scenario& scenario = RotaryScenario())
      : sim::Twin(scenario), RunningServer(Bench(), scenario, RotaryOf(scenario).adc, options) {}
  explicit ServedTwin(const Scenario& scenario, double speed = std::numeric_limits<double>::infinity())
      : ServedTwin(OnFreePorts(speed), scenario) {}
};

/// Has a served twin suffer when so many readings are kept, once each.
class InjectingSink : public ReadingSink {
 public:
  InjectingSink(const RunningServer& served, std::map<int, std::string> faults, MemoryLog& log)
      : served_(served), faults_(std::move(faults)), log_(log) {
    InjectAt(0);
  }
  void Append(const Reading& reading, const Acquisition& block) override {
    log_.Append(reading, block);
    InjectAt(static_cast<int>(log_.readings.size()));
  }

 private:
  void InjectAt(int kept) {
    for (; !faults_.empty() && faults_.begin()->first <= kept; faults_.erase(faults_.begin()))
      served_.Inject(faults_.begin()->second);
  }

  const RunningServer& served_;
  std::map<int, std::string> faults_;
  MemoryLog& log_;
};

}  // namespace twinbench::test
