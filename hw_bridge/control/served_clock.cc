#include "hw_bridge/control/served_clock.h"

#include <fmt/format.h>

#include <string_view>
#include <thread>

#include "hw_bridge/control/scpi.h"

namespace twinbench::hw {
namespace {

constexpr std::string_view kHeldByAnother = "-221,";  // SCPI's settings conflict
constexpr int kTries = 20;
constexpr auto kBetweenTries = std::chrono::milliseconds(100);

}  // namespace

void ScpiClock::Open() const {
  const int opening = line_.Openings();
  if (opening == held_opening_) return;
  TakeHold();
  held_opening_ = opening;
}

/// After a broken connection the server may for a moment take us for another client.
void ScpiClock::TakeHold() const {
  for (int left = kTries;; --left) {
    try {
      return TellScpi(line_, "CLOC:HOLD ON");
    } catch (const DeviceFault& fault) {
      const bool another_has_it = std::string_view(fault.what()).find(kHeldByAnother) != std::string_view::npos;
      if (!another_has_it || left <= 1) throw;
      std::this_thread::sleep_for(kBetweenTries);
    }
  }
}

Time ScpiClock::Now() const {
  Open();
  return Time(Duration(line_.AskWholeNumber("CLOC:NOW?")));
}

void ScpiClock::Wait(Duration duration) {
  Open();
  line_.AskWholeNumber(fmt::format("CLOC:WAIT? {}", duration.count()), duration);
}

void ScpiSimulation::Restart() {
  clock_.Open();
  TellScpi(clock_.line_, run_ == 0 ? "SIM:REST" : fmt::format("SIM:REST {}", run_));
}

void ScpiSimulation::SetPaced(bool paced) {
  clock_.Open();
  TellScpi(clock_.line_, paced ? "SIM:PACE ON" : "SIM:PACE OFF");
}

}  // namespace twinbench::hw
