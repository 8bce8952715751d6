#pragma once

#include <fmt/format.h>

#include <mutex>

#include "tests/hw_control/fake_controller.h"
#include "twin/core/number_text.h"

namespace twinbench::test {

/// What a controller knows of one axis, in the axis's unit; moves are over at once.
struct AxisModel {
  double commanded = 0.0, encoder = 0.0;
  bool referenced = true, motor_on = true;
  double lower = -200.0, upper = 200.0;

  void Go(double to) { commanded = encoder = to; }
};

/// A controller of two axes in the ESP language that can be spoiled; without MS?, as the ESP301, unless told
/// otherwise. One thread answers, another asks: hence the lock.
struct EspModel {
  std::mutex mutex{};
  std::map<int, AxisModel> axis = {{1, {}}, {2, {}}};
  bool knows_status = false;
  int switches = 0;  // of MS?: 2 the lower one, 4 the upper one
  int unit = 7, error = 0;
  int polls_until_done = 0;
  int fastest = 0;      // 0: it knows no VU?
  int decimals = 4;     // that it understands of a group's places
  std::string group{};  // that somebody else has formed: "1,2"; it cannot be formed again

  template <class Change>
  void Become(Change change) {
    const std::lock_guard lock(mutex);
    change(*this);
  }
  /// Several questions may stand on one line.
  FakeController::Reply operator()(const std::string& line) {
    const std::lock_guard lock(mutex);
    std::string answers;
    for (std::size_t from = 0; from <= line.size();) {
      const std::size_t end = std::min(line.find(';', from), line.size());
      if (const std::string answer = Answer(line.substr(from, end - from)); !answer.empty())
        answers += answer + "\r\n";
      from = end + 1;
    }
    return {answers};
  }

  std::string Answer(const std::string& command) {
    if (command == "VE?") return "ESP301 Version 3.0.1";
    if (command == "TB?") return fmt::format("{}, 100, text", std::exchange(error, 0));
    if (command == "TS?") return polls_until_done > 0 ? "Q" : "P";
    AxisModel& a = axis[command[0] == '2' ? 2 : 1];
    const std::string verb = command.substr(command.find_first_not_of("0123456789"));
    if (verb == "MS?" && knows_status) return std::to_string((a.referenced ? 1 : 0) + switches);
    if (verb == "SN?") return std::to_string(unit);
    if (verb == "HN?") return group;
    if (verb == "MO?") return a.motor_on ? "1" : "0";
    if (verb == "MD?") return polls_until_done-- > 0 ? "0" : "1";
    if (verb == "TP?") return fmt::format("{}", a.encoder);
    if (verb == "PA?") return fmt::format("{}", a.commanded);
    if (verb == "SL?") return fmt::format("{}", a.lower);
    if (verb == "SR?") return fmt::format("{}", a.upper);
    if (verb == "VU?" && fastest > 0) return std::to_string(fastest);
    Obey(a, verb);
    return "";
  }

  void Obey(AxisModel& a, const std::string& verb) {
    const bool is_move = verb.starts_with("PA");
    if (verb == "MO") a.motor_on = true;
    if (verb == "OR") axis[1].Go(0.0), axis[2].Go(0.0);
    if (verb.starts_with("SN")) unit = std::stoi(verb.substr(2));
    if (is_move && !a.motor_on) error = 113;
    if (is_move && a.motor_on) a.Go(ParseNumber(verb.substr(2)).value());
    if (verb.starts_with("HL")) GoTogether(verb.substr(2));
    if (verb.starts_with("HN") && !group.empty()) error = 16;
    if (!verb.starts_with('H') && std::string("MO OR ST SN PA").find(verb.substr(0, 2)) == std::string::npos)
      error = 6;
  }

  void GoTogether(const std::string& places) {
    const double step = std::pow(10.0, -decimals);
    const auto cut = [&](const std::string& place) { return std::trunc(ParseNumber(place).value() / step) * step; };
    const auto comma = places.find(',');
    axis[1].Go(cut(places.substr(0, comma)));
    axis[2].Go(cut(places.substr(comma + 1)));
  }
};

}  // namespace twinbench::test
