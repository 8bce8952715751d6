#include "hw_bridge/control/esp_machine.h"

#include <fmt/format.h>

#include <cmath>

#include "hw_bridge/control/esp_words.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr int kReferenced = 1, kLower = 2, kUpper = 4, kMoving = 8;

std::string OfAxis(std::size_t axis, const char* command) {
  return std::to_string(axis + 1) + command;
}

int UnitOf(const MachineAxis& axis) {
  return axis.is_rotary ? kEspDegree : kEspMillimetre;
}

}  // namespace

EspMachine::EspMachine(DeviceLine line, std::vector<MachineAxis> axes, std::vector<AxisLimits> limits,
                       const MachineManner& manner)
    : ControlledMachine(std::move(line), std::move(axes), std::move(limits), manner),
      lost_origin_(Axes().size(), false) {}

/// After every opening: the controller may have been off. Its axes are in mm and degrees, and one group.
void EspMachine::Prepare() {
  const int opening = line().Openings();
  if (opening == prepared_opening_) return;
  if (IsGroup()) FormEspGroup(line(), Axes().size());  // first: a controller of other axes says no
  knows_status_ = EspAnswerTo(line(), "1MS?").has_value();
  if (prepared_opening_ == 0) knows_speed_ = EspAnswerTo(line(), "1VU?").has_value();
  for (std::size_t k = 0; k < Axes().size(); ++k) PrepareAxis(k);
  prepared_opening_ = opening;
}

void EspMachine::PrepareAxis(std::size_t k) {
  const int unit = UnitOf(Axes()[k]);
  if (line().AskWholeNumber(OfAxis(k, "SN?")) != unit) TellEsp(line(), OfAxis(k, "SN") + std::to_string(unit));
  if (!knows_status_ && line().AskWholeNumber(OfAxis(k, "MO?")) == 0) lost_origin_[k] = true;
}

std::vector<AxisLimits> EspMachine::Travel() {
  Prepare();
  std::vector<AxisLimits> travel(Axes().size());
  for (std::size_t k = 0; k < Axes().size(); ++k) {
    RequireEspUnit(line(), OfAxis(k, ""), UnitOf(Axes()[k]));
    travel[k].lower = line().AskNumber(OfAxis(k, "SL?"), Axes()[k].to_SI());
    travel[k].upper = line().AskNumber(OfAxis(k, "SR?"), Axes()[k].to_SI());
  }
  return travel;
}

std::optional<double> EspMachine::Fastest(std::size_t axis) {
  if (!knows_speed_) return std::nullopt;
  return line().AskNumber(OfAxis(axis, "VU?"), Axes()[axis].to_SI());
}

void EspMachine::SetFeed(double feed_m_s) {
  TellEsp(line(), "1HV" + Text(Feed_m_s(feed_m_s), units::mm));
}

void EspMachine::StartMove(const std::vector<double>& to, double feed_m_s) {
  Require(to.size() == Axes().size(), "a move has one coordinate an axis");
  for (std::size_t k = 0; k < to.size(); ++k) RequireWithinLimits(k, to[k]);
  RequireReady(State());
  RequireAllowedAsAgreed();
  if (IsGroup()) SetFeed(feed_m_s);
  std::string command = IsGroup() ? "1HL" : "1PA";
  for (std::size_t k = 0; k < to.size(); ++k) command += (k > 0 ? "," : "") + Text(to[k], Axes()[k].to_SI());
  TellEsp(line(), command);
  RequireUnderstood(to);
}

void EspMachine::RequireUnderstood(const std::vector<double>& to) {
  const std::vector<AxisState> states = State();
  for (std::size_t k = 0; k < to.size(); ++k) {
    if (!states[k].referenced)
      StopAndFail(FaultKind::kRestarted, fmt::format("axis {} lost its origin as the move began", Axes()[k].name));
    if (std::abs(states[k].commanded - to[k]) <= Understood(Axes()[k])) continue;
    StopAndFail(FaultKind::kRefused, fmt::format("axis {} was commanded to {} and understood {}", Axes()[k].name,
                                                 Place(k, to[k]), Place(k, states[k].commanded)));
  }
}

void EspMachine::StartArc(const Arc& arc) {
  if (arc.axes != std::array<std::size_t, 2>{0, 1} || Axes()[0].is_rotary || Axes()[1].is_rotary)
    line().Fail(FaultKind::kRefused, "it goes round with its axes 1 and 2 only, which must be linear");
  const std::vector<AxisState> states = State();
  RequireReady(states);
  const double radius_m = std::hypot(states[0].encoder - arc.centre_m[0], states[1].encoder - arc.centre_m[1]);
  for (const std::size_t k : {0, 1}) {
    RequireWithinLimits(k, arc.centre_m[k] - radius_m);
    RequireWithinLimits(k, arc.centre_m[k] + radius_m);
  }
  SetFeed(arc.feed_m_s);
  if (arc.triggers > 0)
    TellEsp(line(), fmt::format("1XT{},{},{}", arc.triggers, Text(arc.first_trigger_rad, units::deg),
                                Text(arc.trigger_step_rad, units::deg)));
  TellEsp(line(), fmt::format("1HC{},{},{}", Text(arc.centre_m[0], units::mm), Text(arc.centre_m[1], units::mm),
                              Text(arc.sweep_rad, units::deg)));
}

void EspMachine::StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) {
  RequireReady(State());
  TellEsp(line(), fmt::format("{}{},{}", OfAxis(axis, "XV"), Text(speed_rad_s, units::deg),
                              PrintInUnit(ToSeconds(ramp) * 1e3, 1.0)));
}

bool EspMachine::Settles(Duration within) {
  Prepare();
  if (!manner().polls_pass_time) return ControlledMachine::Settles(within);
  const std::string query = fmt::format("1XD{}", PrintInUnit(ToSeconds(within) * 1e3, 1.0));
  const std::string answer = line().Ask(query, within);
  if (answer != "0" && answer != "1") line().FailProtocol(query, answer, "0 or 1");
  return answer == "1";
}

bool EspMachine::AskDone() {
  for (std::size_t k = 0; k < Axes().size(); ++k) {
    const std::string query = OfAxis(k, "MD?");
    const std::string answer = line().Ask(query);
    if (answer != "0" && answer != "1") line().FailProtocol(query, answer, "0 or 1");
    if (answer == "0") return false;
  }
  return true;
}

/// All questions go in one line, for a look at five axes would be twenty ways to the controller and back.
std::vector<AxisState> EspMachine::State() {
  Prepare();
  std::string questions;
  for (std::size_t k = 0; k < Axes().size(); ++k) {
    for (const char* query : {"PA?", "TP?", "MD?"}) questions += (questions.empty() ? "" : ";") + OfAxis(k, query);
    questions += ";" + OfAxis(k, knows_status_ ? "MS?" : "MO?");
  }
  std::string answer = line().Ask(questions);
  const std::function<std::string()> next = [&, first = true]() mutable {
    if (!first) answer = line().NextLine();
    first = false;
    return answer;
  };
  std::vector<AxisState> states;
  for (std::size_t k = 0; k < Axes().size(); ++k) states.push_back(ReadAxis(k, next));
  return states;
}

/// The status comes last, so that it speaks for the places before it.
AxisState EspMachine::ReadAxis(std::size_t k, const std::function<std::string()>& next_answer) {
  const auto number = [&](const char* query, double to_SI) {
    const std::string answer = next_answer();
    const auto number_SI = ParseInUnit(answer, to_SI);
    if (!number_SI) line().FailProtocol(OfAxis(k, query), answer, "a number");
    return *number_SI;
  };
  AxisState state;
  state.commanded = number("PA?", Axes()[k].to_SI());
  state.encoder = number("TP?", Axes()[k].to_SI());
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

void EspMachine::SendStop() {
  TellEsp(line(), StopWord());
}

void EspMachine::SendHome() {
  Prepare();
  for (std::size_t k = 0; k < Axes().size() && !knows_status_; ++k) TellEsp(line(), OfAxis(k, "MO"));
  TellEsp(line(), "OR");
  lost_origin_.assign(Axes().size(), false);
}

}  // namespace twinbench::hw
