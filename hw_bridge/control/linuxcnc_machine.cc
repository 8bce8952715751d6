#include "hw_bridge/control/linuxcnc_machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <thread>

#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr int kDecimals = 9;     // of a number in a program, which knows no exponents
constexpr double kShown = 1e-6;  // mm or deg: the last digit of a place that it tells
// Of a limit that is told as a feed, which is whole and not negative.
constexpr double kLimitScale = 1e6, kLimitOffset = 1e6;
constexpr Duration kBegins = std::chrono::milliseconds(500), kHomePoll = std::chrono::milliseconds(50);
constexpr int kMostErrors = 100;
constexpr std::string_view kLetters = "XYZABC";  // in the order in which places are told

std::size_t IndexOf(char letter) {
  return kLetters.find(letter);
}

/// @param errors  Of which a screen beside us may have taken all.
std::string InWords(const std::string& errors) {
  return errors.empty() ? "it does not say why" : errors;
}

MachineManner InDecimals(MachineManner manner) {
  if (manner.numbers.decimals < 0) manner.numbers.decimals = kDecimals;
  return manner;
}

}  // namespace

std::string LinuxCncHello(const std::string& connect_password) {
  return fmt::format("hello {} twinbench 1.0", connect_password);
}

LinuxCncMachine::LinuxCncMachine(DeviceLine line, std::vector<MachineAxis> axes, std::vector<AxisLimits> limits,
                                 std::vector<LinuxCncAxis> at, std::string enable_password,
                                 const MachineManner& manner)
    : ControlledMachine(std::move(line), std::move(axes), std::move(limits), InDecimals(manner)),
      at_(std::move(at)),
      enable_password_(std::move(enable_password)) {
  Require(at_.size() == Axes().size(), "every axis is somewhere at the controller");
}

/// Asks for something, and gives what follows its name: "get mode" is answered "MODE MDI".
/// @param least  So many words must follow.
std::vector<std::string> LinuxCncMachine::Words(const std::string& what, std::size_t least) {
  const std::string query = "get " + what, answer = line().Ask(query);
  std::istringstream in(answer);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  const bool is_answer =
      words.size() > least && std::ranges::equal(words.front(), what, [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
      });
  if (!is_answer) line().FailProtocol(query, answer, fmt::format("{} and {} words or more", what, least));
  words.erase(words.begin());
  return words;
}

/// Of each of our axes, what is told of its joint.
std::vector<std::string> LinuxCncMachine::OfJoints(const std::string& what) {
  const auto furthest = std::ranges::max_element(at_, {}, &LinuxCncAxis::joint);
  const auto words = Words(what, static_cast<std::size_t>(furthest->joint) + 1);
  std::vector<std::string> ours;
  for (const LinuxCncAxis& axis : at_) ours.push_back(words[static_cast<std::size_t>(axis.joint)]);
  return ours;
}

bool LinuxCncMachine::IsSet(const std::string& what) {
  const std::string command = "set " + what;
  const std::string answer = line().Ask(command);
  if (answer.ends_with(" ACK")) return true;
  if (!answer.ends_with(" NAK")) line().FailProtocol(command, answer, "ACK or NAK");
  return false;
}

void LinuxCncMachine::Set(const std::string& what) {
  if (IsSet(what)) return;
  RequireObeyed();  // which is why, else
  RequireOn();
  line().Fail(FaultKind::kRefused, fmt::format("\"set {}\" was refused: {}", what, InWords(Errors())));
}

/// What it complains about and has not told yet; empty: nothing.
std::string LinuxCncMachine::Errors() {
  std::string all;
  for (int k = 0; k < kMostErrors; ++k) {
    const std::string answer = line().Ask("get error");
    const std::string error = answer.substr(std::min(answer.size(), answer.find(' ') + 1));
    if (error == "OK") break;
    all += (all.empty() ? "" : "; ") + error;
  }
  return all;
}

/// After every opening. Commands are echoed and not acknowledged until it is told otherwise.
void LinuxCncMachine::Greet() {
  const int opening = line().Openings();
  if (opening == greeted_opening_) return;
  line().Ask("set echo off");  // answered by its echo
  Set("verbose on");
  if (!TakesOver()) line().Fail(FaultKind::kRefused, "it refuses the enable_password of the bench file");
  Set("set_wait received");  // else nothing can be said to it while it moves
  sent_.clear();
  greeted_opening_ = opening;
}

void LinuxCncMachine::Prepare() {
  Greet();
  if (greeted_opening_ == prepared_opening_) return;
  RequireAxes();
  prepared_opening_ = greeted_opening_;
}

void LinuxCncMachine::RequireAxes() {
  const std::vector<std::string> types = OfJoints("joint_type"), units = OfJoints("joint_units");
  for (std::size_t k = 0; k < at_.size(); ++k) {
    const bool is_rotary = Axes()[k].is_rotary;
    if (types[k] == (is_rotary ? "ANGULAR" : "LINEAR") && units[k] == (is_rotary ? "DEG" : "MM")) continue;
    line().Fail(FaultKind::kRefused,
                fmt::format("joint {}, which should be axis {} in {}, is {} in {}", at_[k].joint, Axes()[k].name,
                            Axes()[k].unit(), types[k], units[k]));
  }
}

/// It obeys one client, the one who said the password last.
void LinuxCncMachine::RequireObeyed() {
  if (!IsObeyed())
    line().Fail(FaultKind::kRefused, "somebody else commands it now: another program said the enable_password");
}

void LinuxCncMachine::RequireReleased() {
  if (Get("estop") != "OFF")
    line().Fail(FaultKind::kRefused, "its emergency stop is on, and is released by hand only");
}

void LinuxCncMachine::RequireOn() {
  RequireReleased();
  if (!IsOn()) line().Fail(FaultKind::kRefused, "it is switched off: switch it on at the machine");
}

/// Others may have left it in another mode.
void LinuxCncMachine::TakeCommands() {
  RequireOn();
  Errors();  // of what happened before
  if (Get("mode") != "MDI") Set("mode mdi");
}

std::vector<AxisLimits> LinuxCncMachine::Travel() {
  Prepare();
  RequireOn();
  const std::vector<std::string> homed = OfJoints("joint_homed");
  for (std::size_t k = 0; k < homed.size(); ++k) {
    if (homed[k] != "YES")
      line().Fail(FaultKind::kRestarted,
                  fmt::format("axis {} is not homed, and its limits are known only then: home it at the machine",
                              Axes()[k].name));
  }
  TakeCommands();
  Set("set_wait done");  // a feed that is asked for must be the one that was set
  std::vector<AxisLimits> travel(Axes().size());
  for (std::size_t k = 0; k < Axes().size(); ++k) {
    travel[k].lower = Limit(k, "MIN_LIMIT");
    travel[k].upper = Limit(k, "MAX_LIMIT");
  }
  Set("set_wait received");
  return travel;
}

/// A block may use what stands in the configuration, and the feed that it sets can be asked for.
double LinuxCncMachine::Limit(std::size_t axis, const char* which) {
  Set(fmt::format("mdi G94 F[[#<_ini[AXIS_{}]{}>+{:.0f}]*{:.0f}]", at_[axis].letter, which, kLimitOffset,
                  kLimitScale));
  const std::vector<std::string> codes = Words("program_codes", 1);
  for (const std::string& code : codes) {
    const auto told = code.starts_with('F') ? ParseNumber(code.substr(1)) : std::nullopt;
    if (told) return (*told / kLimitScale - kLimitOffset) * Axes()[axis].to_SI();
  }
  line().FailProtocol("get program_codes", fmt::format("{}", fmt::join(codes, " ")), "a feed, F");
}

void LinuxCncMachine::StartMove(const std::vector<double>& to, double feed_m_s) {
  Require(to.size() == Axes().size(), "a move has one coordinate an axis");
  for (std::size_t k = 0; k < to.size(); ++k) RequireWithinLimits(k, to[k]);
  RequireReady(State());
  TakeCommands();
  const bool turns_alone = std::ranges::all_of(Axes(), &MachineAxis::is_rotary);
  std::string block = "G90 G21 G94 G53 ";
  block += turns_alone ? "G0" : fmt::format("G1 F{:.6f}", Feed_m_s(feed_m_s) / units::mm * 60.0);
  for (std::size_t k = 0; k < to.size(); ++k)
    block += fmt::format(" {}{}", at_[k].letter, Text(to[k], Axes()[k].to_SI()));
  sent_.clear();
  Set("mdi " + block);
  sent_ = to;
  sent_at_ = std::chrono::steady_clock::now();
}

void LinuxCncMachine::StartArc(const Arc&) {
  line().Fail(FaultKind::kRefused,
              "circles cannot be measured on it: LinuxCNC gives no pulses at places of an arc, by which the "
              "instruments are latched");
}

std::vector<double> LinuxCncMachine::Places(const std::string& what) {
  const std::vector<std::string> words = Words(what, kLetters.size());
  std::vector<double> places;
  for (std::size_t k = 0; k < at_.size(); ++k) {
    const std::string& word = words[IndexOf(at_[k].letter)];
    const auto place = ParseInUnit(word, Axes()[k].to_SI());
    if (!place) line().FailProtocol("get " + what, word, "a number");
    places.push_back(*place);
  }
  return places;
}

/// Of the axes that do not stand where they were sent, the one that is furthest off; the number of axes if there is
/// none.
std::size_t LinuxCncMachine::FurthestOff(const std::vector<double>& commanded) const {
  std::size_t furthest = commanded.size();
  double most = 1.0;
  for (std::size_t k = 0; k < commanded.size(); ++k) {
    const double off = std::abs(commanded[k] - sent_[k]) / (Understood(Axes()[k]) + kShown * Axes()[k].to_SI());
    if (off <= most) continue;
    most = off;
    furthest = k;
  }
  return furthest;
}

/// A block that it refuses is acknowledged as any other, and complained about afterwards.
bool LinuxCncMachine::AskDone() {
  Prepare();
  if (Get("program_status") != "IDLE") return false;
  if (sent_.empty()) return true;
  const std::vector<double> commanded = Places("abs_cmd_pos");
  const std::size_t off = FurthestOff(commanded);
  if (off == commanded.size()) return true;
  const std::string errors = Errors();
  const bool may_not_have_begun = std::chrono::steady_clock::now() - sent_at_ < kBegins;
  if (errors.empty() && may_not_have_begun) return false;
  RequireOn();
  const bool is_limit = errors.find("limit") != std::string::npos;
  StopAndFail(is_limit ? FaultKind::kLimit : FaultKind::kRefused,
              fmt::format("axis {} was sent to {} and its path ended at {}: {}", Axes()[off].name,
                          Place(off, sent_[off]), Place(off, commanded[off]), InWords(errors)));
}

std::vector<AxisState> LinuxCncMachine::State() {
  Prepare();
  std::string why_off;  // empty: it is on
  if (!IsOn()) why_off = Get("estop") == "OFF" ? "that it is switched off" : "that its emergency stop is on";
  const bool moves = Get("program_status") == "RUNNING";
  const std::vector<double> commanded = Places("abs_cmd_pos");
  const std::vector<double> encoder = Places("abs_act_pos");
  const std::vector<std::string> homed = OfJoints("joint_homed"), limit = OfJoints("joint_limit"),
                                 fault = OfJoints("joint_fault");
  std::vector<AxisState> states(Axes().size());
  for (std::size_t k = 0; k < states.size(); ++k) {
    AxisState& state = states[k];
    state.referenced = homed[k] == "YES";
    state.commanded = state.referenced ? commanded[k] : kNaN;
    state.encoder = state.referenced ? encoder[k] : kNaN;
    state.moving = moves;
    state.in_position = !moves;
    state.limit = limit[k] == "MINHARD" ? -1 : limit[k] == "MAXHARD" ? 1 : 0;
    if (fault[k] != "OK") state.fault = "joint_fault " + fault[k];
    if (!why_off.empty()) state.fault = why_off;
  }
  return states;
}

/// Whoever commands it; but whoever has taken the command keeps it, for an emergency stop say, where nothing moves.
void LinuxCncMachine::SendStop() {
  Greet();
  sent_.clear();
  if (IsSet("abort")) return;
  if (!IsObeyed()) {
    if (Get("program_status") == "IDLE") return;
    TakesOver();
    if (IsSet("abort")) return;
  }
  if (IsOn()) line().Fail(FaultKind::kRefused, "it refuses to abort: " + InWords(Errors()));
}

void LinuxCncMachine::SendHome() {
  Prepare();
  sent_.clear();
  RequireReleased();
  if (!IsOn()) Set("machine on");
  Set("mode manual");
  Set("home -1");
}

bool LinuxCncMachine::FindsOrigin(Duration within) {
  const auto end = std::chrono::steady_clock::now() + within;
  for (;;) {
    if (std::ranges::all_of(OfJoints("joint_homed"), [](const std::string& is) { return is == "YES"; }))
      return true;
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(kHomePoll);
  }
}

}  // namespace twinbench::hw
