#pragma once

#include <cstdint>
#include <deque>
#include <string>

namespace twinbench::live {

/// What has happened so far, as server-sent events, for pages that are opened later or come back. Only the newest are kept.
class Feed {
 public:
  explicit Feed(std::size_t most_events) : most_events_(most_events) {}

  /// What every page is told first, and again when it comes back.
  void Begin(const std::string& json) { begin_ = "event: begin\ndata: " + json + "\n\n"; }
  const std::string& begin() const { return begin_; }

  /// @param kind  A word.  @param json  One line.
  void Add(const std::string& kind, const std::string& json);

  /// Number of the event that comes next, from 0.
  std::uint64_t end() const { return first_ + events_.size(); }

  /// The events from number `next` on, whole ones, until they have `most_B`; where older ones are gone it begins with the oldest
  /// that is kept. `next` becomes the number behind the last.
  std::string From(std::uint64_t& next, std::size_t most_B) const;

 private:
  std::size_t most_events_;
  std::uint64_t first_ = 0;
  std::deque<std::string> events_;
  std::string begin_;
};

}  // namespace twinbench::live
