#pragma once

#include <asio.hpp>
#include <cstdint>
#include <functional>
#include <memory>

#include "hw_bridge/serve/byte_stream.h"
#include "hw_bridge/serve/conversation.h"

namespace twinbench::hw {

struct Patience {
  WallClock::duration idle;   // with a client that says nothing
  WallClock::duration write;  // with a client that takes nothing
};

/// Carries bytes between a client and its conversation. One read, one write and one timer are under way at most, so
/// a client costs a bounded amount of memory whatever it does, and delays nobody else.
class Session : public std::enable_shared_from_this<Session> {
 public:
  /// @param on_end  Called once, when the connection has gone.
  Session(asio::io_context& io, std::unique_ptr<ByteStream> stream, std::unique_ptr<Conversation> conversation,
          Patience patience, std::function<void()> on_end);
  void Start();
  void Close();
  /// Its client has not said a word: nobody loses anything if it goes.
  bool IsUnused() const { return state_ == State::kReading && !heard_; }
  WallClock::time_point began() const { return began_; }

 private:
  enum class State { kGoing, kReading, kWaiting, kSending };
  void Read();
  void Received(std::size_t n);
  void InputEnded();
  void GoOn();
  void Do(Step step);
  void Send(bool then_close);
  void WaitFor(WallClock::duration duration);
  void GiveUpAfter(WallClock::duration duration);

  std::unique_ptr<ByteStream> stream_;
  std::unique_ptr<Conversation> conversation_;
  Patience patience_;
  std::function<void()> on_end_;
  asio::io_context& io_;
  asio::steady_timer wait_, limit_;
  InputBuffer input_;
  std::string output_;
  WallClock::time_point began_ = WallClock::now();
  State state_ = State::kGoing;
  std::uint64_t turn_ = 0;  // of the conversation; tells a late timer that it is over
  bool heard_ = false, reading_ = false, input_ended_ = false, closed_ = false;
};

}  // namespace twinbench::hw
