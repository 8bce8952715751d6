#pragma once

#include <deque>
#include <string>
#include <vector>

#include "hw_bridge/serve/conversation.h"
#include "hw_bridge/serve/served.h"

namespace twinbench::hw {

/// What came of one command: an answer (empty: none), or an operation that will have one.
struct Outcome {
  std::string answer;
  Poll poll;
};

/// A line-oriented instrument dialect: commands on a line, separated by `;`, done one after the other; the answers
/// go out when all are done and the wall clock has caught up with the bench.
class CommandConversation : public Conversation {
 public:
  static constexpr std::size_t kLongestLine = 4096;
  static constexpr double kLongestPatience_s = 3600.0;  // of a watchdog

  explicit CommandConversation(Served& served) : served_(served) {}
  ~CommandConversation() override;
  Step Next(InputBuffer& input) override;

 protected:
  virtual Outcome Execute(const std::string& command) = 0;
  /// A command threw a BenchError.
  virtual void Failed(const std::string& what) = 0;
  virtual std::string Join(const std::vector<std::string>& answers) const = 0;
  virtual std::string LineTooLong() = 0;
  Served& served() { return served_; }
  /// A client shows its token. @return whether it is the one.
  bool Show(std::string_view token);
  /// Whether this client may do more than look and stop.
  bool MayChange() const { return trusted_ || served_.token.empty(); }
  /// From here on whatever moves is stopped when this client goes away or falls silent. @param patience_s  0: no more.
  void BeMissed(double patience_s);
  double Patience_s() const;
  /// Faults of a device strike the line in which a query of it stands.
  void Asks(const std::string& device);

 private:
  enum class State { kIdle, kRunning, kReplying };
  Step Begin(InputBuffer& input);
  void RunCommands();
  void Take(Outcome outcome);
  void Prepare();
  Step Reply();

  Served& served_;
  bool trusted_ = false;
  State state_ = State::kIdle;
  std::deque<std::string> commands_;
  std::vector<std::string> answers_;
  Poll poll_;
  Injected fault_ = Injected::kNone;
  Time line_began_{};
  WallClock::time_point reply_at_{};
};

}  // namespace twinbench::hw
