#include "tests/hw_ad/served_twin.h"

namespace twinbench::test {
namespace {

hw::ServeOptions At(int iiod_port) {
  hw::ServeOptions options;
  options.iiod_port = iiod_port;
  options.scpi_port = options.esp_port = 0;
  options.pty = false;
  return options;
}

}  // namespace

ServedTwin::ServedTwin(const Scenario& scenario, int iiod_port)
    : twin_(scenario), server_(twin_.Bench(), scenario, At(iiod_port)), thread_([this] { server_.Run(); }) {
  scpi_.connect({asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(server_.Addresses().scpi_port)});
  scpi_.set_option(asio::ip::tcp::no_delay(true));
  Ask("CLOC:HOLD ON;:SIM:PACE OFF;:SIM:REST;*OPC?");
}

ServedTwin::~ServedTwin() {
  server_.Stop();
  thread_.join();
}

std::string ServedTwin::Ask(const std::string& line) const {
  asio::write(scpi_, asio::buffer(line + "\n"));
  if (line.back() != '?') return "";
  std::string answer;
  asio::read_until(scpi_, asio::dynamic_buffer(answer), '\n');
  return answer.substr(0, answer.size() - 1);
}

void ServedTwin::Inject(const std::string& kind, int count) const {
  Ask("SIM:FAUL adc," + kind + "," + std::to_string(count) + ";*OPC?");
}

Time ServedTwin::Now() const {
  return Time(Duration(std::stoll(Ask("CLOC:NOW?"))));
}

void ServedTwin::Wait(Duration duration) {
  Ask("CLOC:WAIT? " + std::to_string(duration.count()) + ";*OPC?");
}

}  // namespace twinbench::test
