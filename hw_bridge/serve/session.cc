#include "hw_bridge/serve/session.h"

#include <exception>

namespace twinbench::hw {

Session::Session(asio::io_context& io, std::unique_ptr<ByteStream> stream,
                 std::unique_ptr<Conversation> conversation, Patience patience, std::function<void()> on_end)
    : stream_(std::move(stream)),
      conversation_(std::move(conversation)),
      patience_(patience),
      on_end_(std::move(on_end)),
      io_(io),
      wait_(io),
      limit_(io) {}

void Session::Start() {
  Read();
  GoOn();
}

void Session::Close() {
  if (closed_) return;
  closed_ = true;
  wait_.cancel();
  limit_.cancel();
  stream_->Close();
  conversation_.reset();
  on_end_();
}

void Session::Read() {
  if (reading_ || input_ended_ || closed_) return;
  const std::span<char> space = input_.Space();
  if (space.empty()) return;
  reading_ = true;
  stream_->ReadSome(space, [self = shared_from_this()](const asio::error_code& error, std::size_t n) {
    self->reading_ = false;
    error ? self->InputEnded() : self->Received(n);
  });
}

void Session::Received(std::size_t n) {
  input_.Commit(n);
  heard_ = true;
  state_ == State::kReading ? GoOn() : Read();  // the latter notices a client that goes away during an operation
}

/// What was asked before is still answered, unless that takes waiting.
void Session::InputEnded() {
  input_ended_ = true;
  if (state_ == State::kReading || state_ == State::kWaiting) Close();
}

void Session::GoOn() {
  state_ = State::kGoing;
  ++turn_;
  limit_.cancel();
  asio::post(io_, [self = shared_from_this()] {
    if (self->closed_) return;
    try {
      self->Do(self->conversation_->Next(self->input_));
    } catch (const std::exception&) {
      self->Close();
    }
  });
}

void Session::Do(Step step) {
  output_ = std::move(step.bytes);
  switch (step.kind) {
    case Step::Kind::kRead:
      if (input_ended_) return Close();
      state_ = State::kReading;
      GiveUpAfter(patience_.idle);
      break;
    case Step::Kind::kSend:
      Send(false);
      break;
    case Step::Kind::kWait:
      if (input_ended_) return Close();
      WaitFor(step.wait);
      break;
    case Step::Kind::kSilence:
      state_ = State::kWaiting;
      GiveUpAfter(patience_.idle);
      break;
    case Step::Kind::kClose:
      return output_.empty() ? Close() : Send(true);
  }
  Read();
}

void Session::Send(bool then_close) {
  state_ = State::kSending;
  GiveUpAfter(patience_.write);
  stream_->Write(output_, [self = shared_from_this(), then_close](const asio::error_code& error, std::size_t) {
    error || then_close ? self->Close() : self->GoOn();
  });
}

void Session::WaitFor(WallClock::duration duration) {
  state_ = State::kWaiting;
  wait_.expires_after(duration);
  wait_.async_wait([self = shared_from_this()](const asio::error_code& error) {
    if (!error) self->GoOn();
  });
}

void Session::GiveUpAfter(WallClock::duration duration) {
  limit_.expires_after(duration);
  limit_.async_wait([self = shared_from_this(), turn = turn_](const asio::error_code& error) {
    if (!error && turn == self->turn_) self->Close();
  });
}

}  // namespace twinbench::hw
