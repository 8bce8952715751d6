#include "hw_bridge/control/scpi_instruments.h"

#include <fmt/format.h>

#include <thread>

#include "hw_bridge/control/scpi.h"
#include "twin/core/number_text.h"
#include "twin/core/units.h"

namespace twinbench::hw {
namespace {

constexpr Duration kLookAtIndexer = std::chrono::milliseconds(50);

}  // namespace

AutocollimatorReading ScpiAutocollimator::Read() {
  const std::string query = "AUT:READ?";
  const std::string answer = line_.Ask(query);
  const auto fields = SplitScpi(answer);
  const bool is_pair = fields && fields->size() == 2;
  const auto yaw_rad = is_pair ? ParseScpiNumber((*fields)[0], units::arcsec) : std::nullopt;
  const auto tilt_rad = is_pair ? ParseScpiNumber((*fields)[1], units::arcsec) : std::nullopt;
  if (!yaw_rad || !tilt_rad) line_.FailProtocol(query, answer, "<yaw arcsec>,<tilt arcsec>");
  return {*yaw_rad, *tilt_rad};
}

double ScpiThermometer::Read_degC() {
  const std::string query = "TEMP?";
  const std::string answer = line_.Ask(query);
  const auto temperature_degC = ParseScpiNumber(answer, 1.0);
  if (!temperature_degC) line_.FailProtocol(query, answer, "a number of degC");
  return *temperature_degC;
}

void ScpiGoniometer::MoveTo(double yaw_rad, double tilt_rad) {
  TellScpi(line_, fmt::format("GON:MOVE {},{}", PrintInUnit(yaw_rad, units::arcsec),
                              PrintInUnit(tilt_rad, units::arcsec)));
}

void ScpiFixture::Mount(int setup, double clamp_rad, double reseat_rad) {
  TellScpi(line_, fmt::format("FIXT:MOUN {},{},{}", setup, PrintInUnit(clamp_rad, units::deg),
                              PrintInUnit(reseat_rad, units::deg)));
}

void ScpiIndexer::IndexTo(int tooth, double angle_rad) {
  const auto end = std::chrono::steady_clock::now() + FromSeconds(words_.move_timeout_s);
  const std::string command =
      Filled(words_.move, {{"{tooth}", std::to_string(tooth)}, {"{deg}", PrintInUnit(angle_rad, units::deg)}});
  TellScpi(line_, command, FromSeconds(words_.move_timeout_s));
  while (!words_.done.empty() && line_.AskWholeNumber(words_.done) != 1) {
    if (std::chrono::steady_clock::now() > end)
      line_.Fail(FaultKind::kNotInPosition,
                 fmt::format("tooth {} is not seated after {:g} s", tooth, words_.move_timeout_s));
    std::this_thread::sleep_for(kLookAtIndexer);
  }
}

void ScpiMachineFixture::Clear() {
  TellScpi(line_, "FIXT:CLE");
}

void ScpiMachineFixture::Mount(int setup, const std::string& what) {
  TellScpi(line_, fmt::format("FIXT:MOUN {},\"{}\"", setup, what));
}

}  // namespace twinbench::hw
