#include "hw_bridge/control/dialogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

namespace twinbench::hw {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr Duration kFirstPause = std::chrono::milliseconds(20);
constexpr Duration kLongestPause = std::chrono::milliseconds(500);
/// A serial controller that answers at all has begun to within this time.
constexpr Duration kQuiet = std::chrono::milliseconds(100);
constexpr Duration kHearsWhileItWaits = std::chrono::milliseconds(50);  // from look to look whether a stop was asked for

}  // namespace

Dialogue::Dialogue(Address address, std::string identity_query, std::string identity)
    : address_(std::move(address)), identity_query_(std::move(identity_query)), identity_(std::move(identity)) {}

void Dialogue::Fail(FaultKind kind, const std::string& device, const std::string& why) {
  Close();
  throw DeviceFault(kind, device, fmt::format("{} ({})", why, address_.Text()));
}

void Dialogue::Connect(const std::string& device, Duration patience) {
  const auto end = SteadyClock::now() + patience;
  for (Duration pause = kFirstPause;; pause = std::min(2 * pause, kLongestPause)) {
    OpenedLink opened = OpenLink(address_, patience);
    link_ = std::move(opened.link);
    if (link_) return link_->EndLinesWith(EndOfLine(line_.answer_ends));
    if (SteadyClock::now() + pause > end) Fail(*opened.failure, device, opened.why);
    std::this_thread::sleep_for(pause);
  }
}

void Dialogue::Open(const std::string& device, Duration patience) {
  if (link_) return;
  Connect(device, patience);
  Meet(device, patience);
}

/// Behind the opening of the connection.
void Dialogue::Meet(const std::string& device, Duration patience, bool is_greeted) {
  Identify(device, patience, is_greeted);
  for (const std::string& introduction : introductions_) Introduce(device, introduction, patience);
  ++openings_;
}

void Dialogue::SayFirst(const std::string& word, const std::string& device, Duration patience) {
  if (link_) {
    if (link_->HasUnread()) Send(device, word, patience);
    return;
  }
  Connect(device, patience);
  Send(device, (hears_greeted_only_ ? identity_query_ + "\n" : "") + word, patience);
  Meet(device, patience, hears_greeted_only_);
}

bool Dialogue::IsExpected(const std::string& answer) const {
  return identity_known_ ? answer == identity_ : !answer.empty() && answer.starts_with(identity_);
}

/// Where an identity is asked for, what comes before it is told from it. Where none is, an answer that was missed
/// may be as late again.
void Dialogue::ReadOldAnswersAway(Duration patience) {
  const bool may_be_missed = identity_query_.empty() && openings_ > 0;
  may_be_missed ? link_->ReadAway(patience, 3 * patience) : link_->ReadAway(kQuiet, patience);
}

void Dialogue::Identify(const std::string& device, Duration patience, bool is_greeted) {
  if (IsSerial()) ReadOldAnswersAway(patience);
  if (identity_query_.empty()) return;
  if (!is_greeted) Send(device, identity_query_ + "\n", patience);
  const std::string answer = AwaitIdentity(device, patience);
  if (!IsExpected(answer))
    Fail(FaultKind::kIdentity, device,
         fmt::format("\"{}\" answers; expected {}\"{}\"", answer,
                     identity_known_ ? "as before " : "what begins with ", identity_));
  // The answer may have been that to an older query; and who is greeted may echo what was said with it.
  if (IsSerial() || is_greeted) link_->ReadAway(kQuiet, patience);
  identity_ = answer;
  identity_known_ = true;
}

void Dialogue::Introduce(const std::string& device, const std::string& introduction, Duration patience) {
  Send(device, introduction + "\n", patience);
  const std::string answer = NextLine(device, patience);
  if (!answer.starts_with("0,"))
    Fail(FaultKind::kRefused, device, fmt::format("token or watchdog of the bench file are refused: {}", answer));
}

/// The first line; on a serial line the first that is the identity, or else the last.
std::string Dialogue::AwaitIdentity(const std::string& device, Duration patience) {
  const auto end = SteadyClock::now() + patience;
  std::string answer = NextLine(device, patience);
  while (IsSerial() && !IsExpected(answer)) {
    const LinkResult next = link_->ReadLine(std::max<Duration>(end - SteadyClock::now(), Duration(0)));
    if (next.failure) break;
    answer = next.line;
  }
  return answer;
}

void Dialogue::Send(const std::string& device, const std::string& text, Duration patience) {
  const std::string end = EndOfLine(line_.ends);
  std::string with_ends;
  for (const char c : text) c == '\n' ? with_ends += end : with_ends += c;
  const LinkResult sent = link_->Send(with_ends, patience);
  if (sent.failure) Fail(*sent.failure, device, sent.why);
}

LinkResult Dialogue::ReadLine(Duration patience, const std::function<void()>& meanwhile) {
  if (!meanwhile) return link_->ReadLine(patience);
  for (const auto end = SteadyClock::now() + patience;;) {
    const Duration left = std::max<Duration>(end - SteadyClock::now(), Duration(0));
    LinkResult answer = link_->ReadLine(std::min(left, kHearsWhileItWaits));
    if (answer.failure != FaultKind::kTimeout || left <= kHearsWhileItWaits) return answer;
    try {
      meanwhile();
    } catch (...) {
      Close();
      throw;
    }
  }
}

std::string Dialogue::NextLine(const std::string& device, Duration patience, const std::function<void()>& meanwhile) {
  const LinkResult answer = ReadLine(patience, meanwhile);
  if (answer.failure) Fail(*answer.failure, device, answer.why);
  if (!answer.line.starts_with(line_.answer_begins))
    Fail(FaultKind::kProtocol, device, fmt::format("\"{}\" came; every answer begins otherwise", answer.line));
  return answer.line.substr(line_.answer_begins.size());
}

void Dialogue::Tell(const std::string& device, const std::string& text, Duration patience) {
  Open(device, patience);
  Send(device, text, patience);
}

std::string Dialogue::Ask(const std::string& device, const std::string& text, Duration patience, const std::function<void()>& meanwhile) {
  Open(device, patience);
  if (link_->HasUnread()) Fail(FaultKind::kProtocol, device, "an answer came that nobody had asked for");
  Send(device, text, patience);
  return NextLine(device, patience, meanwhile);
}

}  // namespace twinbench::hw
