#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "hw_bridge/bench_file.h"
#include "twin/core/devices.h"
#include "twin/core/machine.h"
#include "twin/core/reading_column.h"
#include "twin/core/scenario.h"

namespace twinbench::hw {

/// How a bench is shown on the network.
struct ServeOptions {
  std::string bind = "127.0.0.1";
  int iiod_port = 30431, scpi_port = 5025, esp_port = 5026;  // 0: any that is free
  std::string token;                                         // clients must show it to change anything; empty: none
  bool pty = true;                                           // also ESP on a pseudo-terminal
  double speed = 1.0;                               // bench seconds a real second; infinity: as fast as it goes
  int max_connections = 32;                         // of one protocol
  Duration idle_limit = std::chrono::minutes(30);   // a client that says nothing
  Duration write_limit = std::chrono::seconds(20);  // a client that takes nothing
  Duration late = std::chrono::seconds(3);          // that an answer is where a client asked for the fault "late"
};

/// Whether only programs of this computer reach a server at this address.
bool IsOfThisComputerOnly(const std::string& bind);

/// Shows any rotary bench as hardware: IIOD, SCPI and Newport ESP (docs/protocols.md); any bench with a machine by
/// SCPI and Newport ESP. One thread: Run serves until
/// Stop, which may be called from a signal handler's thread.
class Server {
 public:
  /// @param bench  Must have a `simulation`: the server passes its time and starts it again.
  /// @throws BenchError if a port is taken; InputError if the scenario cannot be served (noise-free: no counts).
  Server(RotaryBench bench, const Scenario& scenario, const AdcSettings& adc, const ServeOptions& options);
  /// @param shown  The columns that the instruments of a reading fill.
  Server(MachineBench bench, const std::vector<ReadingColumn>& shown, const Scenario& scenario,
         const ServeOptions& options);
  ~Server();
  ServedAddresses Addresses() const;
  /// From here on `look` is called every `period` of real time, on the thread of Run and between two calls of clients, with the bench where
  /// the wall clock has brought it. Call it before Run.
  void LookEvery(std::chrono::milliseconds period, std::function<void()> look);
  void Run();
  void Stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace twinbench::hw
