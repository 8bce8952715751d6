#include "hw_bridge/control/served_clock.h"

#include <fmt/format.h>

#include "hw_bridge/control/scpi.h"

namespace twinbench::hw {

void ScpiClock::Open() const {
  const int opening = line_.Openings();
  if (opening == held_opening_) return;
  TellScpi(line_, "CLOC:HOLD ON");
  held_opening_ = opening;
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
  TellScpi(clock_.line_, "SIM:REST");
}

void ScpiSimulation::SetPaced(bool paced) {
  clock_.Open();
  TellScpi(clock_.line_, paced ? "SIM:PACE ON" : "SIM:PACE OFF");
}

}  // namespace twinbench::hw
