#include "tests/hw_control/served_twin.h"

#include "hw_bridge/serve/server.h"
#include "twin/sim/twin.h"

namespace twinbench::test {
namespace {

hw::ServeOptions AnyPort(double speed) {
  hw::ServeOptions options;
  options.iiod_port = options.scpi_port = options.esp_port = 0;
  options.speed = speed;
  return options;
}

}  // namespace

ServedTwin::ServedTwin(const Scenario& scenario, double speed)
    : twin_(std::make_unique<sim::Twin>(scenario)),
      server_(std::make_unique<hw::Server>(twin_->Bench(), scenario, AnyPort(speed))),
      thread_([this] { server_->Run(); }) {}

ServedTwin::~ServedTwin() {
  server_->Stop();
  thread_.join();
}

hw::ServedAddresses ServedTwin::Addresses() const {
  return server_->Addresses();
}

std::string ServedTwin::ScpiAddress() const {
  return "tcp:127.0.0.1:" + std::to_string(Addresses().scpi_port);
}

std::string ServedTwin::EspAddress() const {
  return "tcp:127.0.0.1:" + std::to_string(Addresses().esp_port);
}

std::string ServedTwin::TerminalAddress() const {
  return "serial:" + Addresses().pty;
}

}  // namespace twinbench::test
