#include "hw_bridge/serve/esp_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr int kDegree = 7;
constexpr Duration kStopWithin = std::chrono::minutes(10);

std::string Degrees(double angle_rad) {
  return PrintInUnit(std::isfinite(angle_rad) ? angle_rad : 0.0, units::deg);
}

double Angle_rad(const EspCall& call) {
  const auto angle_rad = ParseInUnit(call.command.value, units::deg);
  if (!angle_rad) throw EspError{kEspAxisParameter, true};
  return *angle_rad;
}

/// Where time does not pass by itself, watching a table makes it get on: in a held bench only for MD?.
TableState StateOf(const EspCall& call, bool also_held = false) {
  PacedBench& paced = call.served.paced;
  paced.CatchUp();
  const bool stands = paced.Held() ? also_held : paced.Timeless();
  if (stands && !call.table->State().in_position) paced.LetGetOn(*call.table);
  return call.table->State();
}

void MoveTo(const EspCall& call, double angle_rad) {
  if (!call.table->motor_on) throw EspError{kEspMotorOff, true};
  const int side = angle_rad < call.table->State().encoder_rad ? 1 : 0;
  const ShownTable::Refusal refusal = call.table->Refuses(angle_rad);
  if (refusal == ShownTable::Refusal::kSoftLimit) throw EspError{kEspSoftLimit + side, true};
  if (refusal == ShownTable::Refusal::kLimitSwitch) throw EspError{kEspHardwareLimit + side, true};
  call.served.paced.Spend([&] { call.table->StartMove(angle_rad); });
}

Outcome MoveAbsolute(const EspCall& call) {
  call.served.paced.CatchUp();
  MoveTo(call, Angle_rad(call));
  return {};
}

Outcome MoveRelative(const EspCall& call) {
  call.served.paced.CatchUp();
  MoveTo(call, call.table->State().commanded_rad + Angle_rad(call));
  return {};
}

Outcome Position(const EspCall& call) {
  return {Degrees(StateOf(call).encoder_rad), nullptr};
}

Outcome Desired(const EspCall& call) {
  return {Degrees(StateOf(call).commanded_rad), nullptr};
}

Outcome MotionDone(const EspCall& call) {
  const TableState state = StateOf(call, true);
  // A limit switch ends a motion too.
  return {!state.moving && (state.in_position || state.limit != 0) ? "1" : "0", nullptr};
}

Outcome MotionStatus(const EspCall& call) {
  const TableState state = StateOf(call);
  return {std::to_string((state.referenced ? 1 : 0) + (state.limit < 0 ? 2 : 0) + (state.limit > 0 ? 4 : 0)),
          nullptr};
}

Outcome Stop(const EspCall& call) {
  call.served.paced.CatchUp();
  call.table ? call.table->Stop() : call.served.StopAll();
  return {};
}

Outcome Abort(const EspCall& call) {
  call.served.paced.CatchUp();
  call.served.StopAll();
  return {};
}

Duration Milliseconds(const EspCall& call) {
  if (call.command.value.empty()) return {};
  const auto ms = ParseNumber(call.command.value);
  if (!ms || *ms < 0.0 || *ms > 1e7) throw EspError{kEspOutOfRange};
  return FromSeconds(*ms * 1e-3);
}

/// What follows on the line waits until the motion is over and the delay has passed.
Outcome WaitForStop(const EspCall& call) {
  const Duration delay = Milliseconds(call);
  PacedBench& paced = call.served.paced;
  const Poll settle = paced.Settle(*call.table, kStopWithin);
  Poll pass;
  return {"", [&paced, delay, settle, pass]() mutable -> std::optional<std::string> {
            if (!pass && !settle()) return std::nullopt;
            if (!pass) pass = paced.Pass(delay);
            return pass();
          }};
}

Outcome WaitTime(const EspCall& call) {
  return {"", call.served.paced.Pass(Milliseconds(call))};
}

Outcome Home(const EspCall& call) {
  call.served.paced.Spend([&] { call.table->Home(); });
  return {};
}

Outcome RefuseOrigin(const EspCall&) {
  throw EspError{kEspNotAllowed};  // angles are counted from the origin that OR finds
}

Outcome SetLimit(const EspCall& call, double ShownTable::*limit) {
  const double limit_rad = Angle_rad(call);
  if (std::abs(limit_rad) > ShownTable::kFarthest_rad) throw EspError{kEspAxisParameter, true};
  call.table->*limit = limit_rad;
  return {};
}

Outcome SetLowerLimit(const EspCall& call) {
  return SetLimit(call, &ShownTable::lower_rad);
}

Outcome SetUpperLimit(const EspCall& call) {
  return SetLimit(call, &ShownTable::upper_rad);
}

Outcome LowerLimit(const EspCall& call) {
  return {Degrees(call.table->lower_rad), nullptr};
}

Outcome UpperLimit(const EspCall& call) {
  return {Degrees(call.table->upper_rad), nullptr};
}

Outcome SwitchMotor(const EspCall& call, bool on) {
  if (!on) {
    call.served.paced.CatchUp();
    call.table->Stop();
  }
  call.table->motor_on = on;
  return {};
}

Outcome MotorOn(const EspCall& call) {
  return {call.table->motor_on ? "1" : "0", nullptr};
}

Outcome SetUnit(const EspCall& call) {
  if (ParseWholeNumber(call.command.value) != kDegree) throw EspError{kEspAxisParameter, true};
  return {};
}

Outcome Unit(const EspCall&) {
  return {std::to_string(kDegree), nullptr};
}

Outcome StageIdentity(const EspCall& call) {
  return {fmt::format("{}, SN{}", call.table->name(), call.served.serial), nullptr};
}

Outcome Version(const EspCall& call) {
  return {fmt::format("ESP301 twinbench Version {} SN{}", TWINBENCH_VERSION, call.served.serial), nullptr};
}

Outcome ErrorNumber(const EspCall& call) {
  return {std::to_string(call.client.NextError()), nullptr};
}

Outcome ErrorLine(const EspCall& call) {
  call.served.paced.CatchUp();
  const int number = call.client.NextError();
  const auto servo_cycles = call.served.bench().clock.Now().time_since_epoch() / std::chrono::microseconds(400);
  return {fmt::format("{}, {}, {}", number, servo_cycles, EspErrorText(number)), nullptr};
}

/// A character whose four low bits tell which axes move.
Outcome ControllerStatus(const EspCall& call) {
  call.served.paced.CatchUp();
  const int moving = (call.served.target.State().moving ? 1 : 0) + (call.served.reference.State().moving ? 2 : 0);
  return {std::string(1, static_cast<char>('P' + moving)), nullptr};
}

// --- common queries of IEEE 488.2

Outcome OperationComplete(const EspCall& call) {
  return {"", call.served.AtRest("1")};
}

Outcome StatusByte(const EspCall& call) {
  return {call.client.HasErrors() ? "4" : "0", nullptr};
}

Outcome Options(const EspCall&) {
  return {"0", nullptr};
}

// clang-format off
constexpr EspEntry kEspCommands[] = {
    {"PA", false, EspAxis::kNeeded, true, MoveAbsolute},
    {"PA", true, EspAxis::kNeeded, false, Desired},
    {"PR", false, EspAxis::kNeeded, true, MoveRelative},
    {"TP", true, EspAxis::kNeeded, false, Position},
    {"DP", true, EspAxis::kNeeded, false, Desired},
    {"MD", true, EspAxis::kNeeded, false, MotionDone},
    {"MS", true, EspAxis::kNeeded, false, MotionStatus},
    {"ST", false, EspAxis::kOptional, false, Stop},
    {"AB", false, EspAxis::kNone, false, Abort},
    {"WS", false, EspAxis::kNeeded, false, WaitForStop},
    {"WT", false, EspAxis::kNone, true, WaitTime},
    {"OR", false, EspAxis::kNeeded, false, Home},
    {"DH", false, EspAxis::kNeeded, false, RefuseOrigin},
    {"SL", false, EspAxis::kNeeded, true, SetLowerLimit},
    {"SL", true, EspAxis::kNeeded, false, LowerLimit},
    {"SR", false, EspAxis::kNeeded, true, SetUpperLimit},
    {"SR", true, EspAxis::kNeeded, false, UpperLimit},
    {"MO", false, EspAxis::kNeeded, false, [](const EspCall& call) { return SwitchMotor(call, true); }},
    {"MO", true, EspAxis::kNeeded, false, MotorOn},
    {"MF", false, EspAxis::kNeeded, false, [](const EspCall& call) { return SwitchMotor(call, false); }},
    {"MF", true, EspAxis::kNeeded, false, MotorOn},
    {"SN", false, EspAxis::kNeeded, true, SetUnit},
    {"SN", true, EspAxis::kNeeded, false, Unit},
    {kEspShowToken, false, EspAxis::kNone, true, ShowEspToken<EspCall>},
    {kEspWatchdog, false, EspAxis::kNone, true, ArmEspWatchdog<EspCall>},
    {"ID", true, EspAxis::kNeeded, false, StageIdentity},
    {"VE", true, EspAxis::kNone, false, Version},
    {"TE", true, EspAxis::kNone, false, ErrorNumber},
    {"TB", true, EspAxis::kNone, false, ErrorLine},
    {"*IDN", true, EspAxis::kNone, false, Version},
    {"*OPC", true, EspAxis::kNone, false, OperationComplete},
    {"*STB", true, EspAxis::kNone, false, StatusByte},
    {"*OPT", true, EspAxis::kNone, false, Options},
    {"TS", true, EspAxis::kNone, false, ControllerStatus},
};
// clang-format on

}  // namespace

std::span<const EspEntry> EspCommands() {
  return kEspCommands;
}

bool EspOnlyAsks(const std::string& name) {
  constexpr std::array<std::string_view, 10> kQueries = {"TP", "DP", "MD", "MS", "ID",
                                                         "VE", "TE", "TB", "TS", "XD"};
  return std::ranges::find(kQueries, name) != kQueries.end();
}

}  // namespace twinbench::hw
