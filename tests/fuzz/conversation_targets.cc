#include <limits>

#include "hw_bridge/serve/esp_conversation.h"
#include "hw_bridge/serve/esp_machine_conversation.h"
#include "hw_bridge/serve/iiod_conversation.h"
#include "hw_bridge/serve/scpi_conversation.h"
#include "tests/fuzz/plain_bench.h"
#include "tests/fuzz/target.h"
#include "twin/benches/names.h"
#include "twin/core/bench_format.h"

/// All that a client says to a server.
namespace twinbench::fuzz {
namespace {

constexpr double kTimeless = std::numeric_limits<double>::infinity();
constexpr auto kMostPatience = std::chrono::milliseconds(20);  // an answer that a fault makes late is not waited for
constexpr int kMostWaits = 50, kMostSteps = 5000;

/// As a session does it, but for the socket: bytes come in pieces, answers go nowhere.
void Converse(hw::Conversation& conversation, std::string_view bytes) {
  hw::InputBuffer input;
  int waits = 0;
  for (int steps = 0; steps < kMostSteps; ++steps) {
    const std::span<char> space = input.Space();
    const std::size_t n = std::min(space.size(), bytes.size());
    std::copy_n(bytes.begin(), n, space.begin());
    input.Commit(n);
    bytes.remove_prefix(n);
    const hw::Step step = conversation.Next(input);
    using Kind = hw::Step::Kind;
    if (step.kind == Kind::kClose || step.kind == Kind::kSilence) return;
    if (step.kind == Kind::kRead && n == 0) return;
    if (step.kind == Kind::kWait && (step.wait > kMostPatience || ++waits > kMostWaits)) return;
  }
}

Scenario ScenarioOf(const char* bench) {
  Scenario scenario;
  scenario.bench = bench;
  return scenario;
}

const Scenario kOfRotary = ScenarioOf(kRotaryBench), kOfMachine = ScenarioOf(kCircularBench);

struct ServedRotary {
  PlainRotary rotary;
  hw::ServedBench served{rotary.Bench(), kOfRotary, AdcSettings{}, kTimeless};
};

struct ServedPlainMachine {
  PlainMachine machine;
  hw::ServedMachine served{machine.Bench(), InstrumentColumns(FormatOf(kCircularBench).columns), kOfMachine, kTimeless};
};

template <class Speaks, class Shown>
void ConverseWith(std::string_view bytes) {
  Shown shown;
  Speaks conversation(shown.served);
  Converse(conversation, bytes);
}

constexpr Target kConversationTargets[] = {
    {"iiod", ConverseWith<hw::IiodConversation, ServedRotary>, ""},
    {"scpi", ConverseWith<hw::ScpiConversation, ServedRotary>, ""},
    {"esp", ConverseWith<hw::EspConversation, ServedRotary>, ""},
    {"scpi_machine", ConverseWith<hw::ScpiConversation, ServedPlainMachine>, ""},
    {"esp_machine", ConverseWith<hw::EspMachineConversation, ServedPlainMachine>, ""},
};

}  // namespace

std::span<const Target> ConversationTargets() {
  return kConversationTargets;
}

}  // namespace twinbench::fuzz
