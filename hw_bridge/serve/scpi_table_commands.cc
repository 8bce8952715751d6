#include <fmt/format.h>

#include <cmath>

#include "hw_bridge/serve/scpi_commands.h"
#include "hw_bridge/serve/scpi_parameters.h"
#include "hw_bridge/serve/served_bench.h"
#include "twin/core/units.h"
namespace twinbench::hw {
namespace {

constexpr double kLongestWait_s = 1e7;

ServedBench& RotaryOf(const ScpiCall& call) {
  return static_cast<ServedBench&>(call.served);  // nobody else has these commands
}

ShownTable& TableOf(const ScpiCall& call) {
  if (call.number != 1 && call.number != 2) throw ScpiError{-114, ""};
  RotaryOf(call).StrikeRestarts();
  return call.number == 1 ? RotaryOf(call).target : RotaryOf(call).reference;
}

ShownTable& Asked(const ScpiCall& call) {
  ShownTable& table = TableOf(call);
  call.client.Asks(table.name());
  return table;
}

/// Where bench time does not run by itself nor is held, watching a table must make it get on.
TableState StateOf(const ScpiCall& call, ShownTable& table) {
  RotaryOf(call).paced.CatchUp();
  PacedBench& paced = RotaryOf(call).paced;
  if (paced.Timeless() && !paced.Held() && !table.State().in_position) paced.LetGetOn(table);
  return table.State();
}

Outcome Move(const ScpiCall& call) {
  ShownTable& table = TableOf(call);
  const double angle_rad = ScpiNumber(call.parameters[0], units::deg);
  RotaryOf(call).paced.CatchUp();
  switch (table.Refuses(angle_rad)) {
    case ShownTable::Refusal::kSoftLimit:
      throw ScpiError{-222, "soft limit"};
    case ShownTable::Refusal::kLimitSwitch:
      throw ScpiError{-222, "limit switch"};
    case ShownTable::Refusal::kNone:
      break;
  }
  RotaryOf(call).paced.Spend([&] { table.StartMove(angle_rad); });
  return {};
}

Outcome Encoder(const ScpiCall& call) {
  return {PrintScpi(StateOf(call, Asked(call)).encoder_rad, units::deg), nullptr};
}

Outcome Commanded(const ScpiCall& call) {
  return {PrintScpi(StateOf(call, Asked(call)).commanded_rad, units::deg), nullptr};
}

Outcome State(const ScpiCall& call) {
  const TableState state = StateOf(call, Asked(call));
  return {fmt::format("{},{},{:d},{:d},{:d},{},\"{}\"", PrintScpi(state.commanded_rad, units::deg),
                      PrintScpi(state.encoder_rad, units::deg), state.moving, state.in_position, state.referenced,
                      state.limit, state.fault),
          nullptr};
}

Outcome Settled(const ScpiCall& call) {
  ShownTable& table = Asked(call);
  const double within_s = ScpiNumber(call.parameters[0], 1.0);
  if (within_s < 0.0 || within_s > kLongestWait_s) throw ScpiError{-222, ""};
  return {"", RotaryOf(call).paced.Settle(table, FromSeconds(within_s))};
}

Outcome Stop(const ScpiCall& call) {
  ShownTable& table = TableOf(call);
  RotaryOf(call).paced.CatchUp();
  table.Stop();
  return {};
}

Outcome Home(const ScpiCall& call) {
  ShownTable& table = TableOf(call);
  RotaryOf(call).paced.Spend([&] { table.Home(); });
  return {};
}

Outcome SetLimit(const ScpiCall& call, double ShownTable::*limit) {
  const double limit_rad = ScpiNumber(call.parameters[0], units::deg);
  if (std::abs(limit_rad) > ShownTable::kFarthest_rad) throw ScpiError{-222, ""};
  TableOf(call).*limit = limit_rad;
  return {};
}

Outcome Limit(const ScpiCall& call, double ShownTable::*limit) {
  return {PrintScpi(Asked(call).*limit, units::deg), nullptr};
}

Outcome SetLowerLimit(const ScpiCall& call) {
  return SetLimit(call, &ShownTable::lower_rad);
}

Outcome SetUpperLimit(const ScpiCall& call) {
  return SetLimit(call, &ShownTable::upper_rad);
}

Outcome LowerLimit(const ScpiCall& call) {
  return Limit(call, &ShownTable::lower_rad);
}

Outcome UpperLimit(const ScpiCall& call) {
  return Limit(call, &ShownTable::upper_rad);
}

// clang-format off
constexpr ScpiCommand kTableCommands[] = {
    {"ROTation#:ANGLe", false, 1, 0, Move},
    {"ROTation#:ANGLe", true, 0, 0, Encoder},
    {"ROTation#:ANGLe:COMMand", true, 0, 0, Commanded},
    {"ROTation#:SETTled", true, 1, 0, Settled},
    {"ROTation#:STATe", true, 0, 0, State},
    {"ROTation#:STOP", false, 0, 0, Stop},
    {"ROTation#:HOME", false, 0, 0, Home},
    {"ROTation#:LIMit:LOWer", false, 1, 0, SetLowerLimit},
    {"ROTation#:LIMit:UPPer", false, 1, 0, SetUpperLimit},
    {"ROTation#:LIMit:LOWer", true, 0, 0, LowerLimit},
    {"ROTation#:LIMit:UPPer", true, 0, 0, UpperLimit},
};
// clang-format on

}  // namespace

std::span<const ScpiCommand> ScpiTableCommands() {
  return kTableCommands;
}

}  // namespace twinbench::hw
