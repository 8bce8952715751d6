#include "tools/live/feed.h"
#include "tools/live/gate.h"
#include "twin/core/secret_token.h"

namespace twinbench::live {
namespace {

const Gate kGate = {"0123456789abcdef", 8080};

Request Good(const std::string& method = "GET", const std::string& path = "/") {
  return {method, path + "?token=" + kGate.token, "127.0.0.1:8080", "", "", ""};
}

/// 0: it is let in.
int StatusOf(const Request& request) {
  const auto judged = kGate.Judge(request);
  const auto* refused = std::get_if<Refused>(&judged);
  return refused ? refused->status : 0;
}

TEST(Gate, LetsInWhoeverHasTheToken) {
  EXPECT_EQ(StatusOf(Good()), 0);
  EXPECT_EQ(StatusOf(Good("GET", "/events")), 0);
  Request by_name = Good("POST", "/stop");
  by_name.host = "localhost:8080";
  by_name.origin = "http://localhost:8080";
  by_name.fetch_site = "same-origin";
  EXPECT_EQ(StatusOf(by_name), 0);
}

/// A good request in which one thing is another one.
void ExpectForbidden(std::string Request::*thing, const std::vector<const char*>& others) {
  for (const char* other : others) {
    Request request = Good("POST", "/stop");
    request.*thing = other;
    EXPECT_EQ(StatusOf(request), 403) << other;
  }
}

TEST(Gate, RefusesEveryTokenButTheRightOne) {
  ExpectForbidden(&Request::target,
                  {"/stop", "/stop?token=", "/stop?token=0123456789abcde", "/stop?token=0123456789abcdef0",
                   "/stop?token=0123456789abcdeF", "/stop?other=0123456789abcdef", "/stop?x=1&token=0123456789abcdef",
                   "/stop?token=0123456789abcdef&x=1"});
}

TEST(Gate, RefusesPagesOfOtherOriginsWhateverTheyKnowAndNamesThatWereMadeToLeadHere) {
  ExpectForbidden(&Request::origin, {"http://evil.example", "null", "https://127.0.0.1:8080", "http://127.0.0.1:8081",
                                     "http://localhost:8080"});
  ExpectForbidden(&Request::fetch_site, {"cross-site", "same-site"});
  ExpectForbidden(&Request::host,
                  {"evil.example:8080", "", "127.0.0.1", "127.0.0.1:8081", "127.0.0.1:8080.evil.example"});
}

TEST(Gate, StopsPausesAndResumesByPostAlone) {
  for (const auto& [path, wish] :
       {std::pair{"/stop", Wish::kStop}, std::pair{"/pause", Wish::kPause}, std::pair{"/resume", Wish::kResume}}) {
    EXPECT_EQ(std::get<Granted>(kGate.Judge(Good("POST", path))).wish, wish) << path;
    EXPECT_EQ(StatusOf(Good("GET", path)), 405) << path;
  }
  EXPECT_EQ(StatusOf(Good("POST", "/events")), 405);
  for (const char* path : {"/etc/passwd", "//"}) EXPECT_EQ(StatusOf(Good("GET", path)), 404) << path;
}

TEST(Gate, TakesAPageUpWhereItWasCutOff) {
  Request request = Good("GET", "/events");
  request.last_event = "41";
  EXPECT_EQ(std::get<Granted>(kGate.Judge(request)).next_event, 42u);
  for (const char* nonsense : {"", "-1", "1x", "18446744073709551615", "99999999999999999999"}) {
    request.last_event = nonsense;
    EXPECT_EQ(std::get<Granted>(kGate.Judge(request)).next_event, 0u) << nonsense;
  }
}

TEST(Token, IsLongAndNeverTheSame) {
  const std::string token = NewToken();
  EXPECT_EQ(token.size(), 64u);
  EXPECT_NE(token, NewToken());
  EXPECT_TRUE(IsToken(token, token));
}

TEST(Feed, GivesWholeEventsOnceAndInOrder) {
  Feed feed(100);
  for (const char* json : {"1", "2", "3"}) feed.Add("reading", json);
  std::uint64_t next = 1;
  EXPECT_EQ(feed.From(next, 1), "id: 1\nevent: reading\ndata: 2\n\n");
  EXPECT_EQ(feed.From(next, 1000), "id: 2\nevent: reading\ndata: 3\n\n");
  EXPECT_EQ(feed.From(next, 1000), "");
  EXPECT_EQ(next, feed.end());
}

TEST(Feed, KeepsTheNewestAndHasNothingForAPageThatIsAheadOfIt) {
  Feed feed(2);
  for (const char* json : {"1", "2", "3"}) feed.Add("reading", json);
  std::uint64_t next = 0, ahead = 500;  // ahead: of a program that ran before at the same port
  EXPECT_EQ(feed.From(next, 1000), "id: 1\nevent: reading\ndata: 2\n\nid: 2\nevent: reading\ndata: 3\n\n");
  EXPECT_EQ(next, 3u);
  EXPECT_EQ(feed.From(ahead, 1000), "");
}

}  // namespace
}  // namespace twinbench::live
