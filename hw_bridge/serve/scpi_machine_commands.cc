#include <fmt/format.h>

#include "hw_bridge/serve/scpi_commands.h"
#include "hw_bridge/serve/scpi_parameters.h"
#include "hw_bridge/serve/served_machine.h"
#include "twin/core/units.h"

/// The instruments on a machine, and who mounts them. The machine itself speaks ESP.
namespace twinbench::hw {
namespace {

constexpr long long kMostSamples = 1'000'000, kMostLines = 1'000'000, kMostTeeth = 1'000'000;
constexpr std::size_t kMostAtOnce = 100;  // a line stays within what clients read as one

ServedMachine& MachineOf(const ScpiCall& call) {
  return static_cast<ServedMachine&>(call.served);  // nobody else has these commands
}

ServedMachine& AskedInstruments(const ScpiCall& call) {
  call.client.Asks(kServedInstruments);
  MachineOf(call).paced.CatchUp();
  return MachineOf(call);
}

/// ",<ns>,<status>,<value>,..."; a channel without a value is 9.91E37.
std::string SampleText(const ServedMachine& served, const Reading& sample) {
  std::string text = fmt::format("{},{}", sample.time.time_since_epoch().count(), ReadingStatusName(sample.status));
  for (const ReadingColumn& channel : served.channels) {
    const std::string value = channel.print(sample);
    text += "," + (value.empty() ? PrintScpi(kNaN, 1.0) : value);
  }
  return text;
}

Outcome Channels(const ScpiCall& call) {
  std::string text;
  for (const ReadingColumn& channel : AskedInstruments(call).channels)
    text += (text.empty() ? "" : ",") + channel.name;
  return {text, nullptr};
}

Outcome ReadNow(const ScpiCall& call) {
  ServedMachine& served = AskedInstruments(call);
  Reading sample;
  served.paced.Spend([&] { sample = served.bench.instruments.Read(); });
  return {SampleText(served, sample), nullptr};
}

Outcome LookNow(const ScpiCall& call) {
  ServedMachine& served = AskedInstruments(call);
  Reading sample;
  served.paced.Spend([&] { sample = served.bench.instruments.Look(); });
  return {SampleText(served, sample), nullptr};
}

Outcome Index(const ScpiCall& call) {
  ServedMachine& served = MachineOf(call);
  if (!served.bench.indexer) throw ScpiError{-241, "no indexer"};
  const int tooth = static_cast<int>(ScpiWholeNumber(call.parameters[0], -kMostTeeth, kMostTeeth));
  const double angle_rad = ScpiNumber(call.parameters[1], units::deg);
  served.paced.Spend([&] { served.bench.indexer->IndexTo(tooth, angle_rad); });
  return {};
}

Outcome Arm(const ScpiCall& call) {
  ServedMachine& served = MachineOf(call);
  served.paced.CatchUp();
  const int samples = static_cast<int>(ScpiWholeNumber(call.parameters[0], 1, kMostSamples));
  const bool at_lines = call.parameters.size() > 1;
  served.bench.instruments.Arm(samples, at_lines ? static_cast<int>(ScpiWholeNumber(call.parameters[1], 0, kMostLines)) : 0);
  served.latched.clear();
  served.overrun = false;
  return {};
}

Outcome Fetch(const ScpiCall& call) {
  ServedMachine& served = AskedInstruments(call);
  served.Collect();
  const std::size_t count = std::min(served.latched.size(), kMostAtOnce);
  std::string text = fmt::format("{},{:d}", count, served.overrun);
  for (std::size_t k = 0; k < count; ++k) {
    text += "," + SampleText(served, served.latched.front());
    served.latched.pop_front();
  }
  return {text, nullptr};
}

Outcome ClearFixture(const ScpiCall& call) {
  ServedMachine& served = MachineOf(call);
  served.paced.Spend([&] { served.bench.fixture.Clear(); });
  return {};
}

Outcome MountOnMachine(const ScpiCall& call) {
  ServedMachine& served = MachineOf(call);
  const int setup = static_cast<int>(ScpiWholeNumber(call.parameters[0], 0, 1'000'000));
  const std::string what = call.parameters.size() > 1 ? call.parameters[1] : "";
  served.paced.Spend([&] { served.bench.fixture.Mount(setup, what); });
  return {};
}

// clang-format off
constexpr ScpiCommand kMachineCommands[] = {
    {"INSTrument:CHANnels", true, 0, 0, Channels},
    {"INSTrument:READ", true, 0, 0, ReadNow},
    {"INSTrument:LOOK", true, 0, 0, LookNow},
    {"INSTrument:ARM", false, 1, 1, Arm},
    {"INSTrument:FETCh", true, 0, 0, Fetch},
    {"INDexer:MOVE", false, 2, 0, Index},
    {"FIXTure:CLEar", false, 0, 0, ClearFixture},
    {"FIXTure:MOUNt", false, 1, 1, MountOnMachine},
};
// clang-format on

}  // namespace

std::span<const ScpiCommand> ScpiMachineCommands() {
  return kMachineCommands;
}

}  // namespace twinbench::hw
