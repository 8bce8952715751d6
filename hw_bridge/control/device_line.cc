#include "hw_bridge/control/device_line.h"

#include <fmt/format.h>

#include <algorithm>

#include "hw_bridge/control/waiting.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr Duration kHurriedPatience = std::chrono::seconds(1);
constexpr auto kHurries = std::chrono::seconds(10);

}  // namespace

Duration DeviceLine::Patience() const {
  return std::chrono::steady_clock::now() < hurries_until_ ? std::min(timeout_, kHurriedPatience) : timeout_;
}

void DeviceLine::SayFirst(const std::string& command) {
  hurries_until_ = std::chrono::steady_clock::now() + kHurries;
  has_heard_ = has_heard_ || (stop_asked_ && stop_asked_());
  const Waiting waiting(device_, {});
  if (!command.empty()) dialogue_->SayFirst(command + "\n", device_, Patience());
}

std::string DeviceLine::Ask(const std::string& query, Duration beyond) {
  RequireGoingOn();
  const Waiting waiting(device_, beyond);
  return dialogue_->Ask(device_, query + "\n", Patience() + beyond, [this] { RequireGoingOn(); });
}

std::string DeviceLine::NextLine() {
  return dialogue_->NextLine(device_, Patience(), [this] { RequireGoingOn(); });
}

void DeviceLine::RequireGoingOn() {
  if (has_heard_ || !stop_asked_ || !stop_asked_()) return;
  has_heard_ = true;
  throw DeviceFault(FaultKind::kStopped, "operator", "the run was stopped");
}

double DeviceLine::AskNumber(const std::string& query, double to_SI) {
  const std::string answer = Ask(query);
  const auto number_SI = ParseInUnit(answer, to_SI);
  if (!number_SI) FailProtocol(query, answer, "a number");
  return *number_SI;
}

long long DeviceLine::AskWholeNumber(const std::string& query, Duration beyond) {
  const std::string answer = Ask(query, beyond);
  const auto number = ParseWholeNumber(answer);
  if (!number) FailProtocol(query, answer, "a whole number");
  return *number;
}

int DeviceLine::Openings() {
  const Waiting waiting(device_, {});
  dialogue_->Open(device_, Patience());
  return dialogue_->openings();
}

void DeviceLine::Fail(FaultKind kind, const std::string& why) const {
  throw DeviceFault(kind, device_, fmt::format("{} ({})", why, dialogue_->address().Text()));
}

void DeviceLine::StopAndFail(const std::function<void()>& stop, FaultKind kind, const std::string& why) const {
  try {
    stop();
  } catch (const DeviceFault& fault) {
    Fail(kind, fmt::format("{}; it could not be stopped: {}", why, fault.what()));
  }
  Fail(kind, why);
}

void DeviceLine::FailProtocol(const std::string& query, const std::string& answer, const std::string& expected) {
  dialogue_->Close();
  Fail(FaultKind::kProtocol, fmt::format("\"{}\" is answered \"{}\"; expected {}", query, answer, expected));
}

}  // namespace twinbench::hw
