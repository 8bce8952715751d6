#pragma once

#include <cstdint>
#include <string>
#include <variant>

namespace twinbench::live {

/// What of a request decides about it.
struct Request {
  std::string method, target;          // "GET", "/events?token=..."
  std::string host, origin, fetch_site;  // headers; empty: not there
  std::string last_event;              // of a page that comes back: the last event that it has seen
};

enum class Wish { kPage, kEvents, kStop, kPause, kResume };

struct Granted {
  Wish wish = Wish::kPage;
  std::uint64_t next_event = 0;  // kEvents: the first that the page has not seen
};

struct Refused {
  int status = 403;
  std::string why;
  bool knew_token = false;
};

/// Whom the page is for: a browser on this computer that was opened with the printed address.
struct Gate {
  std::string token;
  int port = 0;

  /// Refuses, in this order: names that are not this computer's own (a page elsewhere whose name was made to lead here), pages of any
  /// other origin, a token that is missing or wrong (each 403), addresses that are none (404) and methods that do not go with them (405).
  std::variant<Granted, Refused> Judge(const Request& request) const;
};

}  // namespace twinbench::live
