#include "hw_bridge/control/scpi_instruments.h"

#include <fmt/format.h>

#include "hw_bridge/control/scpi.h"
#include "twin/core/number_text.h"
#include "twin/core/units.h"

namespace twinbench::hw {
void ScpiFixture::Mount(int setup, double clamp_rad, double reseat_rad) {
  TellScpi(line_, fmt::format("FIXT:MOUN {},{},{}", setup, PrintInUnit(clamp_rad, units::deg),
                              PrintInUnit(reseat_rad, units::deg)));
}

void ScpiMachineFixture::Clear() {
  TellScpi(line_, "FIXT:CLE");
}

void ScpiMachineFixture::Mount(int setup, const std::string& what) {
  TellScpi(line_, fmt::format("FIXT:MOUN {},\"{}\"", setup, what));
}

}  // namespace twinbench::hw
