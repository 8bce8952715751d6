#include "hw_bridge/control/esp_machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "hw_bridge/control/esp_words.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr Duration kPollMachine = std::chrono::milliseconds(20);
constexpr Duration kHomingLook = std::chrono::seconds(1);
constexpr int kUnitMillimetre = 2, kUnitDegree = 7;
constexpr int kReferenced = 1, kLower = 2, kUpper = 4, kMoving = 8;
constexpr double kAllDigits = 1e-9;  // mm or deg: what decimal text may lose on its way

std::string OfAxis(std::size_t axis, const char* command) {
  return std::to_string(axis + 1) + command;
}

}  // namespace

EspMachine::EspMachine(DeviceLine line, std::vector<MachineAxis> axes, std::vector<AxisLimits> limits,
                       EspMachineManner manner)
    : line_(std::move(line)),
      axes_(std::move(axes)),
      limits_(std::move(limits)),
      manner_(manner),
      lost_origin_(axes_.size(), false) {
  Require(limits_.size() == axes_.size(), "limits are one entry an axis");
}

/// Of a command.
std::string EspMachine::Text(double value_SI, double to_SI) const {
  return manner_.decimals < 0 ? PrintInUnit(value_SI, to_SI) : fmt::format("{:.{}f}", value_SI / to_SI, manner_.decimals);
}

/// As far as a controller that was told all digits, or so many decimals, may be from what was meant.
double EspMachine::Understood(const MachineAxis& axis) const {
  const double half_decimal = manner_.decimals < 0 ? 0.0 : 0.5 * std::pow(10.0, -manner_.decimals);
  return (half_decimal + kAllDigits) * axis.to_SI();
}

std::string EspMachine::Place(std::size_t axis, double at) const {
  return fmt::format("{:.6f} {}", at / axes_[axis].to_SI(), axes_[axis].unit());
}

/// After every opening: the controller may have been off. Its axes are in mm and degrees, and one group.
void EspMachine::Prepare() {
  const int opening = line_.Openings();
  if (opening == prepared_opening_) return;
  if (IsGroup()) {
    std::string group = "1HN1";
    for (std::size_t k = 1; k < axes_.size(); ++k) group += "," + std::to_string(k + 1);
    TellEsp(line_, group);  // first: a controller of other axes says no
  }
  knows_status_ = EspKnows(line_, "1MS?");
  for (std::size_t k = 0; k < axes_.size(); ++k) PrepareAxis(k);
  prepared_opening_ = opening;
}

void EspMachine::PrepareAxis(std::size_t k) {
  const int unit = axes_[k].is_rotary ? kUnitDegree : kUnitMillimetre;
  if (line_.AskWholeNumber(OfAxis(k, "SN?")) != unit) TellEsp(line_, OfAxis(k, "SN") + std::to_string(unit));
  if (!knows_status_ && line_.AskWholeNumber(OfAxis(k, "MO?")) == 0) lost_origin_[k] = true;
}

std::vector<AxisLimits> EspMachine::Travel() {
  Prepare();
  std::vector<AxisLimits> travel(axes_.size());
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    travel[k].lower = line_.AskNumber(OfAxis(k, "SL?"), axes_[k].to_SI());
    travel[k].upper = line_.AskNumber(OfAxis(k, "SR?"), axes_[k].to_SI());
  }
  return travel;
}

void EspMachine::AgreeOnLimits() {
  const std::vector<AxisLimits> travel = Travel();
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    AxisLimits& ours = limits_[k];
    if (std::isinf(ours.lower)) ours.lower = travel[k].lower;
    if (std::isinf(ours.upper)) ours.upper = travel[k].upper;
    const double slack = Understood(axes_[k]);
    if (ours.lower >= travel[k].lower - slack && ours.upper <= travel[k].upper + slack) continue;
    line_.Fail(FaultKind::kRefused, fmt::format("the controller allows axis {} {} to {}; the bench file {} to {}",
                                                axes_[k].name, Place(k, travel[k].lower), Place(k, travel[k].upper),
                                                Place(k, ours.lower), Place(k, ours.upper)));
  }
}

void EspMachine::RequireWithinLimits(std::size_t axis, double to) {
  const double slack = Understood(axes_[axis]);
  if (to >= limits_[axis].lower - slack && to <= limits_[axis].upper + slack) return;
  line_.Fail(FaultKind::kLimit,
             fmt::format("a move of axis {} to {} was not sent: its limits are {} and {}", axes_[axis].name,
                         Place(axis, to), Place(axis, limits_[axis].lower), Place(axis, limits_[axis].upper)));
}

void EspMachine::RequireReady(const std::vector<AxisState>& states) {
  for (std::size_t k = 0; k < states.size(); ++k) {
    if (!states[k].referenced)
      line_.Fail(FaultKind::kRestarted,
                 fmt::format("axis {} has lost its origin; its coordinates mean nothing", axes_[k].name));
  }
}

void EspMachine::SetFeed(double feed_m_s) {
  TellEsp(line_, "1HV" + Text(feed_m_s > 0.0 ? feed_m_s : manner_.traverse_m_s, units::mm));
}

void EspMachine::StartMove(const std::vector<double>& to, double feed_m_s) {
  Require(to.size() == axes_.size(), "a move has one coordinate an axis");
  for (std::size_t k = 0; k < to.size(); ++k) RequireWithinLimits(k, to[k]);
  RequireReady(State());
  if (IsGroup()) SetFeed(feed_m_s);
  std::string command = IsGroup() ? "1HL" : "1PA";
  for (std::size_t k = 0; k < to.size(); ++k) command += (k > 0 ? "," : "") + Text(to[k], axes_[k].to_SI());
  TellEsp(line_, command);
  RequireUnderstood(to);
}

void EspMachine::RequireUnderstood(const std::vector<double>& to) {
  const std::vector<AxisState> states = State();
  for (std::size_t k = 0; k < to.size(); ++k) {
    if (!states[k].referenced)
      StopAndFail(FaultKind::kRestarted, fmt::format("axis {} lost its origin as the move began", axes_[k].name));
    if (std::abs(states[k].commanded - to[k]) <= Understood(axes_[k])) continue;
    StopAndFail(FaultKind::kRefused, fmt::format("axis {} was told {} and understood {}", axes_[k].name,
                                                 Place(k, to[k]), Place(k, states[k].commanded)));
  }
}

void EspMachine::StartArc(const Arc& arc) {
  if (arc.axes != std::array<std::size_t, 2>{0, 1} || axes_[0].is_rotary || axes_[1].is_rotary)
    line_.Fail(FaultKind::kRefused, "it goes round with its axes 1 and 2 only, which must be linear");
  const std::vector<AxisState> states = State();
  RequireReady(states);
  const double radius_m = std::hypot(states[0].encoder - arc.centre_m[0], states[1].encoder - arc.centre_m[1]);
  for (const std::size_t k : {0, 1}) {
    RequireWithinLimits(k, arc.centre_m[k] - radius_m);
    RequireWithinLimits(k, arc.centre_m[k] + radius_m);
  }
  SetFeed(arc.feed_m_s);
  if (arc.triggers > 0)
    TellEsp(line_, fmt::format("1XT{},{},{}", arc.triggers, Text(arc.first_trigger_rad, units::deg),
                               Text(arc.trigger_step_rad, units::deg)));
  TellEsp(line_, fmt::format("1HC{},{},{}", Text(arc.centre_m[0], units::mm), Text(arc.centre_m[1], units::mm),
                             Text(arc.sweep_rad, units::deg)));
}

void EspMachine::StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) {
  RequireReady(State());
  TellEsp(line_, fmt::format("{}{},{}", OfAxis(axis, "XV"), Text(speed_rad_s, units::deg),
                             PrintInUnit(ToSeconds(ramp) * 1e3, 1.0)));
}

bool EspMachine::Settles(Duration within) {
  Prepare();
  if (!manner_.polls_pass_time) return PollRunning(within);
  const std::string query = fmt::format("1XD{}", PrintInUnit(ToSeconds(within) * 1e3, 1.0));
  const std::string answer = line_.Ask(query, within);
  if (answer != "0" && answer != "1") line_.FailProtocol(query, answer, "0 or 1");
  return answer == "1";
}

bool EspMachine::AskDone() {
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    const std::string query = OfAxis(k, "MD?");
    const std::string answer = line_.Ask(query);
    if (answer != "0" && answer != "1") line_.FailProtocol(query, answer, "0 or 1");
    if (answer == "0") return false;
  }
  return true;
}

bool EspMachine::PollRunning(Duration within) {
  const auto end = std::chrono::steady_clock::now() + within;
  while (!AskDone()) {
    if (stop_asked_ && stop_asked_()) throw DeviceFault(FaultKind::kStopped, "operator", "the run was stopped");
    const Duration left = end - std::chrono::steady_clock::now();
    if (left <= Duration(0)) return false;
    std::this_thread::sleep_for(std::min(left, kPollMachine));
  }
  return true;
}

/// All questions go in one line, for a look at five axes would be twenty ways to the controller and back.
std::vector<AxisState> EspMachine::State() {
  Prepare();
  std::string questions;
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    for (const char* query : {"PA?", "TP?", "MD?"}) questions += (questions.empty() ? "" : ";") + OfAxis(k, query);
    questions += ";" + OfAxis(k, knows_status_ ? "MS?" : "MO?");
  }
  std::string answer = line_.Ask(questions);
  const std::function<std::string()> next = [&, first = true]() mutable {
    if (!first) answer = line_.NextLine();
    first = false;
    return answer;
  };
  std::vector<AxisState> states;
  for (std::size_t k = 0; k < axes_.size(); ++k) states.push_back(ReadAxis(k, next));
  return states;
}

/// The status comes last, so that it speaks for the places before it.
AxisState EspMachine::ReadAxis(std::size_t k, const std::function<std::string()>& next_answer) {
  const auto number = [&](const char* query, double to_SI) {
    const std::string answer = next_answer();
    const auto number_SI = ParseInUnit(answer, to_SI);
    if (!number_SI) line_.FailProtocol(OfAxis(k, query), answer, "a number");
    return *number_SI;
  };
  AxisState state;
  state.commanded = number("PA?", axes_[k].to_SI());
  state.encoder = number("TP?", axes_[k].to_SI());
  state.in_position = number("MD?", 1.0) == 1.0;
  state.moving = !state.in_position;
  if (!knows_status_) {
    if (number("MO?", 1.0) == 0.0) lost_origin_[k] = true;
    state.referenced = !lost_origin_[k];
    if (!state.referenced) state.commanded = state.encoder = kNaN;
    return state;
  }
  const auto bits = static_cast<long long>(number("MS?", 1.0));
  state.referenced = (bits & kReferenced) != 0;
  state.limit = (bits & kLower) != 0 ? -1 : (bits & kUpper) != 0 ? 1 : 0;
  state.moving = (bits & kMoving) != 0;
  if (!state.referenced) state.commanded = state.encoder = kNaN;
  return state;
}

void EspMachine::Stop() {
  Prepare();
  TellEsp(line_, "ST");
}

void EspMachine::Home() {
  Prepare();
  for (std::size_t k = 0; k < axes_.size() && !knows_status_; ++k) TellEsp(line_, OfAxis(k, "MO"));
  TellEsp(line_, "OR");
  lost_origin_.assign(axes_.size(), false);
  double longest_s = 0.0, passed_s = 0.0;
  for (const AxisLimits& limits : limits_) longest_s = std::max(longest_s, limits.move_timeout_s);
  while (!Settles(kHomingLook)) {
    passed_s += ToSeconds(kHomingLook);
    if (passed_s >= longest_s)
      StopAndFail(FaultKind::kNotInPosition, fmt::format("no origin found in {:.0f} s", passed_s));
  }
  RequireReady(State());
}

/// Why it was stopped is what must be told, also when the machine cannot be reached any more.
void EspMachine::StopAndFail(FaultKind kind, const std::string& why) {
  try {
    Stop();
  } catch (const DeviceFault& fault) {
    line_.Fail(kind, fmt::format("{}; it could not be stopped: {}", why, fault.what()));
  }
  line_.Fail(kind, why);
}

}  // namespace twinbench::hw
