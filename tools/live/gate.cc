#include "tools/live/gate.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "twin/core/secret_token.h"

namespace twinbench::live {
namespace {

/// Value of the one parameter that there is.
std::string_view TokenOf(std::string_view target) {
  constexpr std::string_view kQuery = "?token=";
  const std::size_t query = target.find('?');
  if (query == target.npos || !target.substr(query).starts_with(kQuery)) return {};
  return target.substr(query + kQuery.size());
}

bool IsOwnName(const std::string& host, int port) {
  const std::string at = ":" + std::to_string(port);
  return host == "127.0.0.1" + at || host == "localhost" + at;
}

std::uint64_t NextEvent(const std::string& last) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(last.data(), last.data() + last.size(), number);
  return error == std::errc() && end == last.data() + last.size() && number < UINT64_MAX ? number + 1 : 0;
}

struct Place {
  const char *path, *method;
  Wish wish;
};
constexpr std::array kPlaces = {Place{"/", "GET", Wish::kPage}, Place{"/events", "GET", Wish::kEvents},
                                Place{"/stop", "POST", Wish::kStop}, Place{"/pause", "POST", Wish::kPause},
                                Place{"/resume", "POST", Wish::kResume}};

}  // namespace

std::variant<Granted, Refused> Gate::Judge(const Request& request) const {
  if (!IsOwnName(request.host, port)) return Refused{403, "this is not the address that was printed"};
  if (!request.origin.empty() && request.origin != "http://" + request.host)
    return Refused{403, "asked by a page from elsewhere"};
  if (!request.fetch_site.empty() && request.fetch_site != "same-origin" && request.fetch_site != "none")
    return Refused{403, "asked by a page from elsewhere"};
  if (!IsToken(TokenOf(request.target), token)) return Refused{403, "the token is missing or wrong"};
  const std::string path = request.target.substr(0, request.target.find('?'));
  const auto place = std::ranges::find_if(kPlaces, [&](const Place& p) { return path == p.path; });
  if (place == kPlaces.end()) return Refused{404, "there is no such page", true};
  if (request.method != place->method) return Refused{405, std::string("only ") + place->method, true};
  return Granted{place->wish, NextEvent(request.last_event)};
}

}  // namespace twinbench::live
