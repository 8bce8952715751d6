#include "hw_bridge/serve/command_conversation.h"

#include <utility>

#include "hw_bridge/serve/words.h"
#include "twin/core/errors.h"
#include "twin/core/secret_token.h"

namespace twinbench::hw {

CommandConversation::~CommandConversation() {
  served_.pace().Leave(this);
  if (!served_.watchdog.Leave(this)) return;
  try {
    served_.StopIfMoving();
  } catch (const BenchError&) {  // whoever looks next is told
  }
}

void CommandConversation::BeMissed(double patience_s) {
  served_.watchdog.Arm(this, std::chrono::duration_cast<WallClock::duration>(std::chrono::duration<double>(patience_s)));
}

double CommandConversation::Patience_s() const {
  return std::chrono::duration<double>(served_.watchdog.PatienceOf(this)).count();
}

Step CommandConversation::Next(InputBuffer& input) {
  if (state_ == State::kIdle) return Begin(input);
  if (state_ == State::kRunning) {
    served_.watchdog.Hear(this);
    RunCommands();
    if (poll_) return Step::Wait(kPollEvery);
    Prepare();
  }
  return Reply();
}

Step CommandConversation::Begin(InputBuffer& input) {
  while (auto line = input.TakeLine("\r\n")) {
    if (line->size() > kLongestLine) return Step::Close(LineTooLong());
    if (IsHttp(*line)) return Step::Close();  // what follows may be a page's body
    for (std::string& command : SplitOutsideQuotes(*line, ';')) {
      if (!command.empty()) commands_.push_back(std::move(command));
    }
    if (commands_.empty()) continue;
    state_ = State::kRunning;
    served_.pace().CatchUp();
    line_began_ = served_.pace().Now();
    return Next(input);
  }
  return input.Unread().size() > kLongestLine ? Step::Close(LineTooLong()) : Step::Read();
}

void CommandConversation::RunCommands() {
  while (poll_ || !commands_.empty()) {
    try {
      if (!poll_) {
        const std::string command = std::move(commands_.front());
        commands_.pop_front();
        Take(Execute(command));
      }
      if (!poll_) continue;
      const auto answer = poll_();
      if (!answer) return;
      poll_ = nullptr;
      Take({*answer, nullptr});
    } catch (const BenchError& error) {
      poll_ = nullptr;
      Failed(error.what());
    }
  }
}

void CommandConversation::Take(Outcome outcome) {
  if (!outcome.answer.empty()) answers_.push_back(std::move(outcome.answer));
  poll_ = std::move(outcome.poll);
}

bool CommandConversation::Show(std::string_view token) {
  trusted_ = IsToken(token, served_.token);
  return MayChange();
}

void CommandConversation::Asks(const std::string& device) {
  if (fault_ == Injected::kNone) fault_ = served_.faults.TakeAnswer(device);
}

void CommandConversation::Prepare() {
  state_ = State::kReplying;
  reply_at_ = served_.pace().OnTheWall();
  if (served_.pace().Now() != line_began_) reply_at_ += served_.pace().Lag();
  if (fault_ == Injected::kLate) reply_at_ += served_.late;
}

Step CommandConversation::Reply() {
  if (const auto now = served_.pace().OnTheWall(); now < reply_at_) return Step::Wait(reply_at_ - now);
  state_ = State::kIdle;
  std::string text = Join(answers_);
  answers_.clear();
  const Injected fault = std::exchange(fault_, Injected::kNone);
  if (fault == Injected::kMute) text.clear();
  if (fault == Injected::kPartial) text.resize(text.size() / 2);
  if (fault == Injected::kDisconnect) return Step::Close();
  return Step::Send(std::move(text));
}

}  // namespace twinbench::hw
