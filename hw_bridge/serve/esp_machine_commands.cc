#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hw_bridge/serve/esp_errors.h"
#include "hw_bridge/serve/esp_machine_conversation.h"
#include "hw_bridge/serve/words.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr int kMillimetres = 2, kUnitDegrees = 7;
constexpr double kMostTriggers = 1e6, kLongestSettling_ms = 1e7;

const MachineAxis& AxisOf(const EspMachineCall& call) {
  return call.served.machine.Axes()[call.axis];
}

std::string InUnit(double value_SI, const MachineAxis& axis) {
  return PrintInUnit(std::isfinite(value_SI) ? value_SI : 0.0, axis.to_SI());
}

/// The comma-separated numbers of a group command, as many as there must be.
std::vector<std::string> Values(const EspMachineCall& call, std::size_t count) {
  std::vector<std::string> values = SplitOutsideQuotes(call.command.value, ',');
  if (call.command.value.empty() || values.size() < count) throw EspError{kEspParameterMissing};
  if (values.size() > count) throw EspError{kEspOutOfRange};
  return values;
}

double Number(const std::string& text, double to_SI) {
  const auto number = ParseInUnit(text, to_SI);
  if (!number) throw EspError{kEspOutOfRange};
  return *number;
}

AxisState StateOfAxis(const EspMachineCall& call) {
  PacedClock& paced = call.served.paced;
  if (paced.Timeless() && !paced.Held() && call.served.Moves()) call.served.LetGetOn();
  return call.served.machine.State()[call.axis];
}

/// @throws EspError for a place beyond the soft limits, or further onto a switch.
void RequireAllowed(const EspMachineCall& call, const std::vector<double>& to) {
  const std::vector<AxisState> states = call.served.machine.State();
  for (std::size_t k = 0; k < to.size(); ++k) {
    const AxisLimits& limits = call.served.machine.limits(k);
    const int of_axis = 100 * (static_cast<int>(k) + 1);
    if (to[k] > limits.upper) throw EspError{of_axis + kEspSoftLimit};
    if (to[k] < limits.lower) throw EspError{of_axis + kEspSoftLimit + 1};
    if (states[k].limit * (to[k] - states[k].encoder) > 0.0)
      throw EspError{of_axis + kEspHardwareLimit + (states[k].limit < 0 ? 1 : 0)};
  }
}

Outcome Line(const EspMachineCall& call) {
  const std::vector<MachineAxis>& axes = call.served.machine.Axes();
  const std::vector<std::string> values = Values(call, axes.size());
  std::vector<double> to;
  for (std::size_t k = 0; k < axes.size(); ++k) to.push_back(Number(values[k], axes[k].to_SI()));
  RequireAllowed(call, to);
  call.served.paced.Spend([&] { call.served.machine.StartMove(to, call.client.feed_m_s); });
  return {};
}

/// The others stay where they were sent.
Outcome OneAxis(const EspMachineCall& call) {
  std::vector<double> to;
  for (const AxisState& axis : call.served.machine.State()) to.push_back(axis.commanded);
  to[call.axis] = Number(Values(call, 1)[0], AxisOf(call).to_SI());
  RequireAllowed(call, to);
  call.served.paced.Spend([&] { call.served.machine.StartMove(to, call.client.feed_m_s); });
  return {};
}

Outcome TurnOn(const EspMachineCall& call) {
  const std::vector<std::string> values = Values(call, 2);
  const double speed_rad_s = Number(values[0], units::deg), ramp_ms = Number(values[1], 1.0);
  if (ramp_ms < 0.0 || ramp_ms > kLongestSettling_ms) throw EspError{kEspOutOfRange};
  call.served.paced.Spend([&] { call.served.machine.StartTurning(call.axis, speed_rad_s, FromSeconds(ramp_ms * 1e-3)); });
  return {};
}

Outcome GroupArc(const EspMachineCall& call) {
  const std::vector<std::string> values = Values(call, 3);
  Arc arc;
  arc.centre_m = {Number(values[0], units::mm), Number(values[1], units::mm)};
  arc.sweep_rad = Number(values[2], units::deg);
  arc.feed_m_s = call.client.feed_m_s;
  arc.triggers = std::exchange(call.client.triggers, 0);
  arc.first_trigger_rad = call.client.first_trigger_rad;
  arc.trigger_step_rad = call.client.trigger_step_rad;
  call.served.paced.Spend([&] { call.served.machine.StartArc(arc); });
  return {};
}

Outcome SetTriggers(const EspMachineCall& call) {
  const std::vector<std::string> values = Values(call, 3);
  const auto count = ParseWholeNumber(values[0]);
  if (!count || *count < 0 || static_cast<double>(*count) > kMostTriggers) throw EspError{kEspOutOfRange};
  call.client.first_trigger_rad = Number(values[1], units::deg);
  call.client.trigger_step_rad = Number(values[2], units::deg);
  call.client.triggers = static_cast<int>(*count);
  return {};
}

Outcome Triggers(const EspMachineCall& call) {
  return {fmt::format("{},{},{}", call.client.triggers, PrintInUnit(call.client.first_trigger_rad, units::deg),
                      PrintInUnit(call.client.trigger_step_rad, units::deg)),
          nullptr};
}

Outcome SetFeed(const EspMachineCall& call) {
  const double feed_m_s = Number(call.command.value, units::mm);
  if (feed_m_s < 0.0) throw EspError{kEspOutOfRange};
  call.client.feed_m_s = feed_m_s;
  return {};
}

Outcome Feed(const EspMachineCall& call) {
  return {PrintInUnit(call.client.feed_m_s, units::mm), nullptr};
}

std::string GroupText(const EspMachineCall& call) {
  std::string text;
  for (std::size_t k = 1; k <= call.served.machine.Axes().size(); ++k)
    text += fmt::format("{}{}", k > 1 ? "," : "", k);
  return text;
}

/// There is one group, of all axes in their order.
Outcome MakeGroup(const EspMachineCall& call) {
  if (call.command.value != GroupText(call)) throw EspError{kEspOutOfRange};
  return {};
}

Outcome Group(const EspMachineCall& call) {
  return {GroupText(call), nullptr};
}

Outcome GroupPosition(const EspMachineCall& call) {
  std::string text;
  const std::vector<AxisState> states = call.served.machine.State();
  for (std::size_t k = 0; k < states.size(); ++k)
    text += (k > 0 ? "," : "") + InUnit(states[k].encoder, call.served.machine.Axes()[k]);
  return {text, nullptr};
}

Outcome SettledWithin(const EspMachineCall& call) {
  const double ms = Number(call.command.value, 1.0);
  if (ms < 0.0 || ms > kLongestSettling_ms) throw EspError{kEspOutOfRange};
  ServedMachine& served = call.served;
  return {"", served.paced.Settle([&served](Duration within) { return served.machine.Settles(within); },
                                  FromSeconds(ms * 1e-3))};
}

Outcome StopMachine(const EspMachineCall& call) {
  call.served.StopAll();
  return {};
}

Outcome HomeMachine(const EspMachineCall& call) {
  call.served.paced.Spend([&] { call.served.machine.Home(); });
  return {};
}

Outcome AxisPosition(const EspMachineCall& call) {
  return {InUnit(StateOfAxis(call).encoder, AxisOf(call)), nullptr};
}

Outcome AxisTarget(const EspMachineCall& call) {
  return {InUnit(StateOfAxis(call).commanded, AxisOf(call)), nullptr};
}

Outcome AxisDone(const EspMachineCall& call) {
  const AxisState state = StateOfAxis(call);
  return {!state.moving && (state.in_position || state.limit != 0) ? "1" : "0", nullptr};
}

Outcome AxisStatus(const EspMachineCall& call) {
  const AxisState state = StateOfAxis(call);
  const int bits = (state.referenced ? 1 : 0) + (state.limit < 0 ? 2 : 0) + (state.limit > 0 ? 4 : 0) +
                   (state.moving ? 8 : 0) + (state.in_position ? 16 : 0);
  return {std::to_string(bits), nullptr};
}

Outcome AxisUnit(const EspMachineCall& call) {
  return {std::to_string(AxisOf(call).is_rotary ? kUnitDegrees : kMillimetres), nullptr};
}

Outcome SetSoftLimit(const EspMachineCall& call, double AxisLimits::*limit) {
  const double at = Number(call.command.value, AxisOf(call).to_SI());
  const AxisLimits travel = call.served.bench.machine.Travel()[call.axis];
  if (at < travel.lower || at > travel.upper) throw EspError{kEspAxisParameter, true};
  call.served.machine.limits(call.axis).*limit = at;
  return {};
}

Outcome SoftLimit(const EspMachineCall& call, double AxisLimits::*limit) {
  return {InUnit(call.served.machine.limits(call.axis).*limit, AxisOf(call)), nullptr};
}

Outcome ControllerName(const EspMachineCall& call) {
  return {fmt::format("ESP301 twinbench Version {} SN{}", TWINBENCH_VERSION, call.served.serial), nullptr};
}

Outcome AxisName(const EspMachineCall& call) {
  return {fmt::format("{}, SN{}", AxisOf(call).name, call.served.serial), nullptr};
}

Outcome OldestError(const EspMachineCall& call) {
  return {std::to_string(call.client.NextError()), nullptr};
}

Outcome OldestErrorLine(const EspMachineCall& call) {
  const int number = call.client.NextError();
  const auto servo_cycles = call.served.paced.Now().time_since_epoch() / std::chrono::microseconds(400);
  return {fmt::format("{}, {}, {}", number, servo_cycles, EspErrorText(number)), nullptr};
}

Outcome AllDone(const EspMachineCall& call) {
  return {"", call.served.AtRest("1")};
}

// clang-format off
constexpr EspMachineEntry kEspMachineCommands[] = {
    {"HN", false, EspPart::kGroup, MakeGroup},
    {"HN", true, EspPart::kGroup, Group},
    {"HV", false, EspPart::kGroup, SetFeed},
    {"HV", true, EspPart::kGroup, Feed},
    {"HL", false, EspPart::kGroup, Line},
    {"HC", false, EspPart::kGroup, GroupArc},
    {"HS", false, EspPart::kGroup, StopMachine},
    {"HP", true, EspPart::kGroup, GroupPosition},
    {"XT", false, EspPart::kGroup, SetTriggers},
    {"XT", true, EspPart::kGroup, Triggers},
    {"XD", true, EspPart::kGroup, SettledWithin},
    {"XV", false, EspPart::kAxis, TurnOn},
    {"TP", true, EspPart::kAxis, AxisPosition},
    {"PA", false, EspPart::kAxis, OneAxis},
    {"PA", true, EspPart::kAxis, AxisTarget},
    {"MD", true, EspPart::kAxis, AxisDone},
    {"MS", true, EspPart::kAxis, AxisStatus},
    {"SN", true, EspPart::kAxis, AxisUnit},
    {"SL", false, EspPart::kAxis, [](const EspMachineCall& call) { return SetSoftLimit(call, &AxisLimits::lower); }},
    {"SL", true, EspPart::kAxis, [](const EspMachineCall& call) { return SoftLimit(call, &AxisLimits::lower); }},
    {"SR", false, EspPart::kAxis, [](const EspMachineCall& call) { return SetSoftLimit(call, &AxisLimits::upper); }},
    {"SR", true, EspPart::kAxis, [](const EspMachineCall& call) { return SoftLimit(call, &AxisLimits::upper); }},
    {"ID", true, EspPart::kAxis, AxisName},
    {kEspShowToken, false, EspPart::kController, ShowEspToken<EspMachineCall>},
    {kEspWatchdog, false, EspPart::kController, ArmEspWatchdog<EspMachineCall>},
    {"OR", false, EspPart::kController, HomeMachine},
    {"ST", false, EspPart::kController, StopMachine},
    {"AB", false, EspPart::kController, StopMachine},
    {"VE", true, EspPart::kController, ControllerName},
    {"*IDN", true, EspPart::kController, ControllerName},
    {"TE", true, EspPart::kController, OldestError},
    {"TB", true, EspPart::kController, OldestErrorLine},
    {"*OPC", true, EspPart::kController, AllDone},
};
// clang-format on

}  // namespace

std::span<const EspMachineEntry> EspMachineCommands() {
  return kEspMachineCommands;
}

}  // namespace twinbench::hw
