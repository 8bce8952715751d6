#pragma once

#include <limits>
#include <memory>
#include <thread>

#include "hw_bridge/bench_file.h"
#include "twin/core/scenario.h"

namespace twinbench::hw {
class Server;
}
namespace twinbench::sim {
class Twin;
}

namespace twinbench::test {

/// A twin on free ports of this machine until this goes.
class ServedTwin {
 public:
  /// @param speed  Bench seconds a real second.
  explicit ServedTwin(const Scenario& scenario, double speed = std::numeric_limits<double>::infinity());
  ~ServedTwin();
  hw::ServedAddresses Addresses() const;
  std::string ScpiAddress() const;
  std::string EspAddress() const;
  std::string TerminalAddress() const;

 private:
  std::unique_ptr<sim::Twin> twin_;
  std::unique_ptr<hw::Server> server_;
  std::thread thread_;
};

}  // namespace twinbench::test
