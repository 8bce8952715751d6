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
  explicit HeldTwin(const Scenario& scenario, int iiod_port = 0) : served_(At(iiod_port), scenario) {
    scpi_.connect({asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(served_.at().scpi_port)});
    scpi_.set_option(asio::ip::tcp::no_delay(true));
    Ask("CLOC:HOLD ON;:SIM:PACE OFF;:SIM:REST;*OPC?");
  }

  int iiod_port() const { return served_.at().iiod_port; }
  /// Sends one SCPI line; returns the answer if it ends in a question mark.
  std::string Ask(const std::string& line) const {
    asio::write(scpi_, asio::buffer(line + "\n"));
    if (line.back() != '?') return "";
    std::string answer;
    asio::read_until(scpi_, asio::dynamic_buffer(answer), '\n');
    return answer.substr(0, answer.size() - 1);
  }
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
  mutable asio::io_context io_;
  mutable asio::ip::tcp::socket scpi_{io_};
};

}  // namespace twinbench::test
