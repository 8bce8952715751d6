#include "twin/core/machine_call.h"

#include "twin/core/call_text.h"
#include "twin/core/errors.h"
#include "twin/core/sample_text.h"

namespace twinbench {
namespace {

constexpr const char* kNoSuchRequest = "?";

Arc ParseArc(CallReader& words) {
  Arc arc;
  for (std::size_t& axis : arc.axes) axis = static_cast<std::size_t>(words.Integer());
  for (double& place_m : arc.centre_m) place_m = words.Number();
  arc.sweep_rad = words.Number();
  arc.feed_m_s = words.Number();
  arc.triggers = static_cast<int>(words.Integer());
  arc.first_trigger_rad = words.Number();
  arc.trigger_step_rad = words.Number();
  return arc;
}

std::string PerformMove(MachineController& machine, CallReader& words) {
  const double feed_m_s = words.Number();
  std::vector<double> to;
  while (!words.AtEnd()) to.push_back(words.Number());
  machine.StartMove(to, feed_m_s);
  return "";
}

std::string PerformTurn(MachineController& machine, CallReader& words) {
  const auto axis = static_cast<std::size_t>(words.Integer());
  const double speed_rad_s = words.Number();
  machine.StartTurning(axis, speed_rad_s, Duration(words.Integer()));
  return "";
}

std::string PerformMachine(MachineController& machine, const std::string& verb, CallReader& words) {
  if (verb == "settles") return machine.Settles(Duration(words.Integer())) ? "1" : "0";
  if (verb == "state") return StatesText(machine.State());
  if (verb == "travel") return TravelText(machine.Travel());
  if (verb == "move") return PerformMove(machine, words);
  if (verb == "turn") return PerformTurn(machine, words);
  if (verb == "arc") machine.StartArc(ParseArc(words));
  if (verb == "stop") machine.Stop();
  if (verb == "home") machine.Home();
  return verb == "arc" || verb == "stop" || verb == "home" ? "" : kNoSuchRequest;
}

std::string PerformInstruments(InstrumentSet& instruments, const std::vector<ReadingColumn>& shown,
                               const std::string& verb, CallReader& words) {
  if (verb == "read") return SampleText(instruments.Read(), shown);
  if (verb == "look") return SampleText(instruments.Look(), shown);
  if (verb == "latched") return LatchedText(instruments.Latched(), shown);
  if (verb != "arm") return kNoSuchRequest;
  const auto samples = static_cast<int>(words.Integer());
  instruments.Arm(samples, static_cast<int>(words.Integer()));
  return "";
}

std::string PerformHands(MachineBench& bench, const std::string& device, const std::string& verb, CallReader& words) {
  if (device == "indexer" && bench.indexer && verb == "by_hand") return bench.indexer->IsByHand() ? "1" : "0";
  if (device == "indexer" && bench.indexer && verb == "index") {
    const auto tooth = static_cast<int>(words.Integer());
    bench.indexer->IndexTo(tooth, words.Number());
    return "";
  }
  if (device == "fixture" && verb == "clear") {
    bench.fixture.Clear();
    return "";
  }
  if (device == "fixture" && verb == "mount") {
    const auto setup = static_cast<int>(words.Integer());
    bench.fixture.Mount(setup, words.Rest());
    return "";
  }
  return kNoSuchRequest;
}

std::string PerformOnMachine(MachineBench& bench, const std::vector<ReadingColumn>& shown, const std::string& device,
                             CallReader& words) {
  const std::string verb = words.Word();
  if (device == "machine") return PerformMachine(bench.machine, verb, words);
  if (device == "instruments") return PerformInstruments(bench.instruments, shown, verb, words);
  if (device != kClockDevice || verb != "wait") return PerformHands(bench, device, verb, words);
  bench.clock.Wait(Duration(words.Integer()));
  return "";
}

}  // namespace

std::string Perform(MachineBench& bench, const std::vector<ReadingColumn>& shown, const std::string& device,
                    const std::string& request) {
  CallReader words(request);
  std::string answer = PerformOnMachine(bench, shown, device, words);
  if (answer == kNoSuchRequest)
    throw InputError("device call \"" + device + ": " + request + "\"", "there is no such request",
                     "a call as a record keeps it");
  return answer;
}

}  // namespace twinbench
