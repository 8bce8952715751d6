#pragma once

#include <asio.hpp>
#include <string>
#include <thread>

#include "hw_bridge/serve/server.h"
#include "twin/core/devices.h"
#include "twin/sim/twin.h"

/// A twin behind its network servers, in this process, and the clock of a client that holds its time.
namespace twinbench::test {

class ServedTwin : public Clock {
 public:
  /// @param iiod_port  0: any that is free.
  explicit ServedTwin(const Scenario& scenario, int iiod_port = 0);
  ~ServedTwin() override;

  int iiod_port() const { return server_.Addresses().iiod_port; }
  /// Sends one SCPI line; returns the answer if it ends in a question mark.
  std::string Ask(const std::string& line) const;
  /// The next blocks suffer `kind`.
  void Inject(const std::string& kind, int count = 1) const;

  Time Now() const override;
  void Wait(Duration duration) override;

 private:
  sim::Twin twin_;
  hw::Server server_;
  std::thread thread_;
  mutable asio::io_context io_;
  mutable asio::ip::tcp::socket scpi_{io_};
};

}  // namespace twinbench::test
