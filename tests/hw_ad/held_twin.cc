#include "tests/hw_ad/held_twin.h"

namespace twinbench::test {
namespace {

hw::ServeOptions At(int iiod_port) {
  hw::ServeOptions options = OnFreePorts(1.0);
  options.iiod_port = iiod_port;
  options.pty = false;
  return options;
}

}  // namespace

HeldTwin::HeldTwin(const Scenario& scenario, int iiod_port) : served_(At(iiod_port), scenario) {
  scpi_.connect({asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(served_.at().scpi_port)});
  scpi_.set_option(asio::ip::tcp::no_delay(true));
  Ask("CLOC:HOLD ON;:SIM:PACE OFF;:SIM:REST;*OPC?");
}

std::string HeldTwin::Ask(const std::string& line) const {
  asio::write(scpi_, asio::buffer(line + "\n"));
  if (line.back() != '?') return "";
  std::string answer;
  asio::read_until(scpi_, asio::dynamic_buffer(answer), '\n');
  return answer.substr(0, answer.size() - 1);
}

void HeldTwin::Inject(const std::string& kind, int count) const {
  Ask("SIM:FAUL adc," + kind + "," + std::to_string(count) + ";*OPC?");
}

Time HeldTwin::Now() const {
  return Time(Duration(std::stoll(Ask("CLOC:NOW?"))));
}

void HeldTwin::Wait(Duration duration) {
  Ask("CLOC:WAIT? " + std::to_string(duration.count()) + ";*OPC?");
}

}  // namespace twinbench::test
