#include "hw_bridge/serve/scpi_commands.h"
#include "hw_bridge/serve/scpi_parameters.h"
#include "twin/core/units.h"
namespace twinbench::hw {
namespace {

Outcome Autocollimate(const ScpiCall& call) {
  AutocollimatorReading reading;
  call.served.paced.Spend([&] { reading = call.served.bench().autocollimator.Read(); });
  return {PrintScpi(reading.yaw_rad, units::arcsec) + "," + PrintScpi(reading.tilt_rad, units::arcsec), nullptr};
}

Outcome Temperature(const ScpiCall& call) {
  double temperature_degC = kNaN;
  call.served.paced.Spend([&] { temperature_degC = call.served.bench().thermometer.Read_degC(); });
  return {PrintScpi(temperature_degC, 1.0), nullptr};
}

Outcome TurnGoniometer(const ScpiCall& call) {
  const double yaw_rad = ScpiNumber(call.parameters[0], units::arcsec);
  const double tilt_rad = ScpiNumber(call.parameters[1], units::arcsec);
  call.served.paced.Spend([&] { call.served.bench().goniometer.MoveTo(yaw_rad, tilt_rad); });
  return {};
}

Outcome Mount(const ScpiCall& call) {
  const int setup = static_cast<int>(ScpiWholeNumber(call.parameters[0], 0, 1'000'000));
  const double clamp_rad = ScpiNumber(call.parameters[1], units::deg);
  const double reseat_rad = ScpiNumber(call.parameters[2], units::deg);
  call.served.paced.Spend([&] { call.served.bench().fixture.Mount(setup, clamp_rad, reseat_rad); });
  return {};
}

// clang-format off
constexpr ScpiCommand kInstrumentCommands[] = {
    {"AUTocollimator:READ", true, 0, 0, Autocollimate},
    {"TEMPerature", true, 0, 0, Temperature},
    {"GONiometer:MOVE", false, 2, 0, TurnGoniometer},
    {"FIXTure:MOUNt", false, 3, 0, Mount},
};
// clang-format on

}  // namespace

std::span<const ScpiCommand> ScpiInstrumentCommands() {
  return kInstrumentCommands;
}

}  // namespace twinbench::hw
