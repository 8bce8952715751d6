#include "twin/core/device_call.h"

#include "twin/core/call_text.h"
#include "twin/core/errors.h"

namespace twinbench {
namespace {

CallAnswer Said(const std::string& text = "") {
  return {text, {}};
}

CallAnswer PerformClock(Clock& clock, const std::string& verb, CallReader& words) {
  if (verb != "wait") return Said("?");
  clock.Wait(Duration(words.Integer()));
  return Said();
}

CallAnswer PerformTable(RotaryTable& table, const std::string& verb, CallReader& words) {
  if (verb == "settles") return Said(table.Settles(Duration(words.Integer())) ? "1" : "0");
  if (verb == "state") return Said(StateText(table.State()));
  if (verb == "move") table.StartMove(words.Number());
  if (verb == "stop") table.Stop();
  if (verb == "home") table.Home();
  return Said(verb == "move" || verb == "stop" || verb == "home" ? "" : "?");
}

CallAnswer PerformAdc(AdConverter& adc, const std::string& verb, CallReader& words) {
  if (verb != "acquire") return Said("?");
  const auto n_samples = static_cast<int>(words.Integer());
  Acquisition block = adc.Acquire(n_samples, words.Rest() == "raw");
  return {BlockText(block), std::move(block)};
}

CallAnswer PerformInstrument(RotaryBench& bench, const std::string& device, const std::string& verb,
                             CallReader& words) {
  if (device == "thermometer" && verb == "read") return Said((CallWords() << bench.thermometer.Read_degC()).text());
  if (device == "autocollimator" && verb == "read") {
    const AutocollimatorReading angles = bench.autocollimator.Read();
    return Said((CallWords() << angles.yaw_rad << angles.tilt_rad).text());
  }
  if (device == "goniometer" && verb == "move") {
    const double yaw_rad = words.Number(), tilt_rad = words.Number();
    bench.goniometer.MoveTo(yaw_rad, tilt_rad);
    return Said();
  }
  if (device == "fixture" && verb == "mount") {
    const auto setup = static_cast<int>(words.Integer());
    const double clamp_rad = words.Number(), reseat_rad = words.Number();
    bench.fixture.Mount(setup, clamp_rad, reseat_rad);
    return Said();
  }
  return Said("?");
}

CallAnswer PerformWords(RotaryBench& bench, const std::string& device, CallReader& words) {
  const std::string verb = words.Word();
  if (device == "clock") return PerformClock(bench.clock, verb, words);
  if (device == "target") return PerformTable(bench.target, verb, words);
  if (device == "reference") return PerformTable(bench.reference, verb, words);
  if (device == "adc") return PerformAdc(bench.adc, verb, words);
  return PerformInstrument(bench, device, verb, words);
}

}  // namespace

CallAnswer Perform(RotaryBench& bench, const std::string& device, const std::string& request) {
  CallReader words(request);
  CallAnswer answer = PerformWords(bench, device, words);
  if (answer.text == "?")
    throw InputError("device call \"" + device + ": " + request + "\"", "there is no such request",
                     "a call as a record keeps it");
  return answer;
}

}  // namespace twinbench
