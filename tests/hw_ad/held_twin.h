#pragma once

#include <asio.hpp>
#include <string>

#include "tests/support/served_twin.h"
#include "twin/core/devices.h"

/// A served twin whose time a client holds, and that client's clock.
namespace twinbench::test {

class HeldTwin : public Clock {
 public:
  /// @param iiod_port  0: any that is free.
  explicit HeldTwin(const Scenario& scenario, int iiod_port = 0);

  int iiod_port() const { return served_.at().iiod_port; }
  /// Sends one SCPI line; returns the answer if it ends in a question mark.
  std::string Ask(const std::string& line) const;
  /// The next blocks suffer `kind`.
  void Inject(const std::string& kind, int count = 1) const;

  Time Now() const override;
  void Wait(Duration duration) override;

 private:
  ServedTwin served_;
  mutable asio::io_context io_;
  mutable asio::ip::tcp::socket scpi_{io_};
};

}  // namespace twinbench::test
