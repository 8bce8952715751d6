#include "hw_bridge/serve/scpi_commands.h"
#include "hw_bridge/serve/scpi_parameters.h"
#include "hw_bridge/serve/served_bench.h"
#include "twin/core/units.h"
namespace twinbench::hw {
namespace {

ServedBench& BenchOf(const ScpiCall& call) {
  return static_cast<ServedBench&>(call.served);  // nobody else has these commands
}

Outcome Autocollimate(const ScpiCall& call) {
  AutocollimatorReading reading;
  BenchOf(call).paced.Spend([&] { reading = BenchOf(call).bench().autocollimator.Read(); });
  return {PrintScpi(reading.yaw_rad, units::arcsec) + "," + PrintScpi(reading.tilt_rad, units::arcsec), nullptr};
}

Outcome Temperature(const ScpiCall& call) {
  double temperature_degC = kNaN;
  BenchOf(call).paced.Spend([&] { temperature_degC = BenchOf(call).bench().thermometer.Read_degC(); });
  return {PrintScpi(temperature_degC, 1.0), nullptr};
}

Outcome TurnGoniometer(const ScpiCall& call) {
  const double yaw_rad = ScpiNumber(call.parameters[0], units::arcsec);
  const double tilt_rad = ScpiNumber(call.parameters[1], units::arcsec);
  BenchOf(call).paced.Spend([&] { BenchOf(call).bench().goniometer.MoveTo(yaw_rad, tilt_rad); });
  return {};
}

Outcome Mount(const ScpiCall& call) {
  const int setup = static_cast<int>(ScpiWholeNumber(call.parameters[0], 0, 1'000'000));
  const double clamp_rad = ScpiNumber(call.parameters[1], units::deg);
  const double reseat_rad = ScpiNumber(call.parameters[2], units::deg);
  BenchOf(call).paced.Spend([&] { BenchOf(call).bench().fixture.Mount(setup, clamp_rad, reseat_rad); });
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
