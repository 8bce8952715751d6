#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace twinbench::live {

/// Shows a measurement to browsers on this computer: one page, its events, and a stop. It has a thread of its own; whoever measures
/// never waits for it, and nothing that goes wrong in it reaches the measurement.
class Server {
 public:
  struct Settings {
    int port = 0;                         // 0: any that is free
    std::string_view markup;              // of the page, with its content security policy; outlives the server
    std::function<void()> stop;           // called on the server's thread; must return at once
    std::function<void(bool)> pause = {};  // true: pause, false: go on; likewise. None: nothing can be paused
  };
  /// @throws InputError if the port is taken.
  explicit Server(Settings settings);
  /// Closes every connection.
  ~Server();

  int port() const;
  /// With the token: the address that lets in.
  std::string address() const;

  /// What every page is told first. Call it once, before the first Tell.
  void Begin(const std::string& json);
  /// Of one thread only. Takes some microseconds whatever the browsers do; if events come faster than they can be taken, some are left out
  /// and counted.
  /// @param kind  A word.  @param json  One line.
  void Tell(const char* kind, const std::string& json);
  /// The same of any thread; it may wait for the server's.
  void Post(const char* kind, const std::string& json);
  /// Returns when every page has been told everything, at the latest after a second.
  void Finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace twinbench::live
