#include "hw_bridge/control/esp_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "twin/core/units.h"

namespace twinbench::hw {
namespace {

constexpr Duration kPoll = std::chrono::milliseconds(20);
constexpr int kStatusAxes = 4;  // that TS? tells of
constexpr int kReferencedBit = 1, kLowerBit = 2, kUpperBit = 4;

}  // namespace

EspTable::EspTable(DeviceLine line, int axis, const TableLimits& limits, CommandNumbers numbers,
                   bool polls_pass_time)
    : ControlledTable(std::move(line), limits, numbers), axis_(axis), polls_pass_time_(polls_pass_time) {}

std::string EspTable::Axis(const std::string& command) const {
  return std::to_string(axis_) + command;
}

void EspTable::Tell(const std::string& command) {
  TellEsp(line(), Axis(command));
}

/// After every opening: the controller may have been off. An axis is moved in degrees with its motor on.
void EspTable::Prepare() {
  const int opening = line().Openings();
  if (opening == prepared_opening_) return;
  knows_status_ = EspAnswerTo(line(), Axis("MS?")).has_value();
  if (prepared_opening_ == 0) knows_speed_ = EspAnswerTo(line(), Axis("VU?")).has_value();
  if (line().AskWholeNumber(Axis("SN?")) != kEspDegree) Tell("SN" + std::to_string(kEspDegree));
  const bool motor_is_off = line().AskWholeNumber(Axis("MO?")) == 0;
  if (motor_is_off && !knows_status_) lost_origin_ = true;
  if (motor_is_off && !lost_origin_) Tell("MO");
  prepared_opening_ = opening;
}

void EspTable::SendMove(const std::string& angle_deg) {
  Prepare();
  done_ = false;
  Tell("PA" + angle_deg);
}

bool EspTable::AskDone() {
  const std::string query = Axis("MD?");
  const std::string answer = line().Ask(query, polls_pass_time_ ? kEspHeldPoll : Duration(0));
  if (answer != "0" && answer != "1") line().FailProtocol(query, answer, "0 or 1");
  done_ = answer == "1";
  return done_;
}

bool EspTable::AwaitSettled(Duration within) {
  Prepare();
  return polls_pass_time_ ? PollHeld(within) : PollRunning(within);
}

/// Each poll passes its 50 ms, or less as the table settles: so many of them pass `within`.
bool EspTable::PollHeld(Duration within) {
  const auto polls = std::max<Duration::rep>((within + kEspHeldPoll - Duration(1)) / kEspHeldPoll, 1);
  for (Duration::rep k = 0; k < polls; ++k) {
    if (AskDone()) return true;
  }
  return false;
}

bool EspTable::PollRunning(Duration within) {
  const auto end = std::chrono::steady_clock::now() + within;
  while (!AskDone()) {
    const Duration left = end - std::chrono::steady_clock::now();
    if (left <= Duration(0)) return false;
    std::this_thread::sleep_for(std::min(left, kPoll));
  }
  return true;
}

/// The status comes last, so that it speaks for the angles before it.
TableState EspTable::ReadState() {
  Prepare();
  if (!polls_pass_time_) AskDone();
  TableState state;
  state.in_position = done_;
  state.moving = AskMoving();
  state.commanded_rad = line().AskNumber(Axis("PA?"), units::deg);  // the target; DP? follows the profile
  state.encoder_rad = line().AskNumber(Axis("TP?"), units::deg);
  ReadStatus(state);
  return state;
}

/// One character, whose lowest bits tell which axes move.
bool EspTable::AskMoving() {
  const std::string answer = line().Ask("TS?");
  if (answer.size() != 1) line().FailProtocol("TS?", answer, "one character");
  return axis_ <= kStatusAxes && (answer[0] >> (axis_ - 1) & 1) != 0;
}

void EspTable::ReadStatus(TableState& state) {
  if (!knows_status_) {
    if (line().AskWholeNumber(Axis("MO?")) == 0) lost_origin_ = true;
    state.referenced = !lost_origin_;
    return;
  }
  const auto bits = line().AskWholeNumber(Axis("MS?"));
  state.referenced = (bits & kReferencedBit) != 0;
  state.limit = (bits & kLowerBit) != 0 ? -1 : (bits & kUpperBit) != 0 ? 1 : 0;
}

void EspTable::SendStop() {
  TellEsp(line(), StopWord());
  done_ = false;
}

void EspTable::SendHome() {
  Prepare();
  Tell("MO");
  Tell("OR");
  lost_origin_ = false;
  done_ = false;
}

AllowedMotion EspTable::ReadAllowed() {
  Prepare();
  RequireEspUnit(line(), Axis(""), kEspDegree);
  AllowedMotion allowed{line().AskNumber(Axis("SL?"), units::deg), line().AskNumber(Axis("SR?"), units::deg)};
  if (knows_speed_) allowed.fastest = line().AskNumber(Axis("VU?"), units::deg);
  return allowed;
}

}  // namespace twinbench::hw
