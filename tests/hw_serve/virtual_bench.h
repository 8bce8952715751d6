#pragma once

#include "hw_bridge/serve/esp_conversation.h"
#include "hw_bridge/serve/scpi_conversation.h"
#include "hw_bridge/serve/server.h"
#include "tests/support/rotary_scenario.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

/// A served bench without sockets and threads, on a wall clock that moves only where somebody waits.
namespace twinbench::test {

class VirtualBench {
 public:
  explicit VirtualBench(double speed)
      : served_(twin_.Bench(), scenario_, RotaryOf(scenario_).adc, speed, [this] { return wall_; }) {
    served_.late = hw::ServeOptions{}.late;
  }

  hw::ServedBench& served() { return served_; }
  double Wall_s() const { return std::chrono::duration<double>(wall_.time_since_epoch()).count(); }

  /// On the way it looks for those who are missed, as Server does.
  void Pass(hw::WallClock::duration time) {
    const auto end = wall_ + time;
    for (; guard_ <= end; guard_ += std::chrono::milliseconds(100)) {
      wall_ = guard_;
      if (served_.watchdog.IsMissingThem()) served_.StopIfMoving();
    }
    wall_ = end;
  }

 private:
  Scenario scenario_ = RotaryScenario();
  sim::Twin twin_{scenario_};
  hw::WallClock::time_point wall_{}, guard_{};
  hw::ServedBench served_;
};

/// Who says something to it and waits for the answer; gone with this.
template <class Speaks>
class VirtualClient {
 public:
  explicit VirtualClient(VirtualBench& bench) : bench_(bench), talk_(bench.served()) {}

  void Say(const std::string& lines) {
    std::ranges::copy(lines, input_.Space().begin());
    input_.Commit(lines.size());
    Turn();
  }
  std::string Line() {
    auto end = said_.find('\n');
    for (; end == std::string::npos; end = said_.find('\n')) {
      if (wait_ == hw::WallClock::duration::zero()) throw std::runtime_error("no answer, but: " + said_);
      bench_.Pass(wait_);
      Turn();
    }
    std::string line = said_.substr(0, end);
    said_.erase(0, end + 1);
    if (line.ends_with('\r')) line.pop_back();
    return line;
  }
  std::string Ask(const std::string& text) {
    Say(text + "\n");
    return Line();
  }
  long long AskNumber(const std::string& text) { return std::stoll(Ask(text)); }

 private:
  /// Goes on until it waits for something.
  void Turn() {
    hw::Step step;
    do {
      step = talk_.Next(input_);
      said_ += step.bytes;
    } while (step.kind == hw::Step::Kind::kSend);
    wait_ = step.wait;
  }

  VirtualBench& bench_;
  Speaks talk_;
  hw::InputBuffer input_;
  std::string said_;
  hw::WallClock::duration wait_{};
};

using VirtualScpi = VirtualClient<hw::ScpiConversation>;
using VirtualEsp = VirtualClient<hw::EspConversation>;

}  // namespace twinbench::test
