#pragma once

#include <limits>
#include <string>
#include <thread>

#include "hw_bridge/open_bench.h"
#include "hw_bridge/serve/server.h"
#include "tests/support/rotary_scenario.h"
#include "tests/support/sanitized.h"
#include "twin/benches/rotary_4dof/settings.h"
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

/// A twin that is served from a thread, until this goes.
class ServedTwin {
 public:
  explicit ServedTwin(const hw::ServeOptions& options, const Scenario& scenario = RotaryScenario())
      : twin_(scenario),
        server_(twin_.Bench(), scenario, RotaryOf(scenario).adc, options),
        thread_([this] { server_.Run(); }) {}
  explicit ServedTwin(const Scenario& scenario, double speed = std::numeric_limits<double>::infinity())
      : ServedTwin(OnFreePorts(speed), scenario) {}
  ~ServedTwin() {
    server_.Stop();
    thread_.join();
  }
  ServedTwin(const ServedTwin&) = delete;
  ServedTwin& operator=(const ServedTwin&) = delete;

  hw::ServedAddresses at() const { return server_.Addresses(); }
  std::string ScpiAddress() const { return "tcp:" + at().host + ":" + std::to_string(at().scpi_port); }
  std::string EspAddress() const { return "tcp:" + at().host + ":" + std::to_string(at().esp_port); }
  std::string TerminalAddress() const { return "serial:" + at().pty; }

 private:
  sim::Twin twin_;
  hw::Server server_;
  std::thread thread_;
};

}  // namespace twinbench::test
