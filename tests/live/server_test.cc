#include "tools/live/server.h"

#include <thread>

#include "tests/core/input_error.h"
#include "tests/support/tcp_client.h"

/// The server as a browser meets it, and as those do who are none.
namespace twinbench::live {
namespace {

using std::chrono::duration, std::chrono::milliseconds, std::chrono::steady_clock;
using test::TcpClient, testing::HasSubstr, testing::Not, testing::StartsWith;

constexpr const char* kMarkup =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'sha256-abc'\">page";

class Live : public ::testing::Test {
 protected:
  /// The address's part behind the host: "/?token=...".
  std::string Target(const std::string& path) const {
    return path + server_.address().substr(server_.address().find('?'));
  }
  std::string Asking(const std::string& method, const std::string& target, const std::string& headers = "") const {
    return fmt::format("{} {} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: close\r\n{}\r\n", method, target, server_.port(),
                       headers);
  }
  std::string Ask(const std::string& text) const {
    TcpClient client(server_.port());
    client.Send(text);
    return client.Rest();
  }

  std::atomic<int> stops_ = 0;
  std::atomic<steady_clock::rep> stopped_ = 0;
  Server server_{{0, kMarkup, [this] {
                    stopped_ = steady_clock::now().time_since_epoch().count();
                    ++stops_;
                  }}};
};

TEST_F(Live, ShowsThePageUnderItsOwnPolicy) {
  const std::string answer = Ask(Asking("GET", Target("/")));
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(answer, HasSubstr("Content-Security-Policy: default-src 'none'; script-src 'sha256-abc'; frame-ancestors 'none'\r\n"));
  EXPECT_THAT(answer, HasSubstr("Referrer-Policy: no-referrer"));
  EXPECT_THAT(answer, testing::EndsWith("page"));
}

TEST_F(Live, NothingIsStoppedWithoutTheTokenOrFromElsewhere) {
  const std::string right = Target("/stop");
  const std::string wrong = right.substr(0, right.size() - 1) + (right.back() == '0' ? '1' : '0');
  for (const std::string& asked :
       {Asking("POST", "/stop"), Asking("POST", wrong), Asking("POST", right, "Origin: http://evil.example\r\n"),
        Asking("POST", right, "Sec-Fetch-Site: cross-site\r\n"), Asking("GET", "/"), Asking("GET", "/events"),
        fmt::format("POST {} HTTP/1.1\r\nHost: evil.example:{}\r\n\r\n", right, server_.port())}) {
    EXPECT_THAT(Ask(asked), StartsWith("HTTP/1.1 403")) << asked;
  }
  EXPECT_THAT(Ask(Asking("GET", right)), StartsWith("HTTP/1.1 405"));
  EXPECT_EQ(stops_, 0);
  EXPECT_THAT(Ask(Asking("POST", right)), StartsWith("HTTP/1.1 202"));
  EXPECT_EQ(stops_, 1);
}

TEST_F(Live, PassesOnAPauseToWhoeverCanPause) {
  EXPECT_THAT(Ask(Asking("POST", Target("/pause"))), StartsWith("HTTP/1.1 409")) << "this one cannot";
  std::vector<bool> wishes;
  Server other({0, kMarkup, [] {}, [&](bool pauses) { wishes.push_back(pauses); }});
  const std::string query = other.address().substr(other.address().find('?'));
  for (const char* path : {"/pause", "/resume"}) {
    TcpClient client(other.port());
    client.Send(fmt::format("POST {}{} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: close\r\n\r\n", path, query, other.port()));
    EXPECT_THAT(client.Rest(), StartsWith("HTTP/1.1 202"));
  }
  EXPECT_EQ(wishes, (std::vector<bool>{true, false}));
}

TEST_F(Live, IsToldFromOtherThreadsToo) {
  std::jthread([this] { server_.Post("alarm", "1"); }).join();
  TcpClient client(server_.port());
  client.Send(Asking("GET", Target("/events")));
  EXPECT_THAT(client.Until("data: 1\n\n"), HasSubstr("event: alarm"));
}

TEST_F(Live, OversizedRequestsAreRefused) {
  EXPECT_THAT(Ask(Asking("POST", Target("/stop"), "Content-Length: 1000000\r\n")), StartsWith("HTTP/1.1 413"));
  TcpClient client(server_.port());
  client.Send(Asking("POST", Target("/stop"), "X: " + std::string(20000, 'x') + "\r\n"));
  EXPECT_THAT(client.Rest(), Not(HasSubstr("202")));
  EXPECT_THAT(Ask("nonsense\r\n\r\n"), Not(HasSubstr("202")));
  EXPECT_EQ(stops_, 0);
}

TEST_F(Live, TellsWhatHappensFromTheBeginningToWhoeverComesLater) {
  server_.Begin(R"({"bench":"any"})");
  for (int k = 0; k < 3; ++k) server_.Tell("reading", std::to_string(k));
  TcpClient client(server_.port());
  client.Send(Asking("GET", Target("/events")));
  const std::string heard = client.Until("data: 2\n\n");
  EXPECT_THAT(heard, HasSubstr("Content-Type: text/event-stream"));
  EXPECT_THAT(heard, HasSubstr("event: begin\ndata: {\"bench\":\"any\"}\n\nid: 0\nevent: reading\ndata: 0\n\n"));
  server_.Tell("end", "{}");
  server_.Finish();
  EXPECT_THAT(client.Until("event: end\n"), HasSubstr("id: 3"));
}

TEST_F(Live, APortThatIsTakenIsRefused) {
  EXPECT_THROW((Server{{server_.port(), kMarkup, [] {}}}), InputError);
}

TEST_F(Live, HearsAStopHoweverManyPagesListen) {
  std::vector<std::unique_ptr<TcpClient>> pages;
  int listening = 0;
  for (int k = 0; k < 60; ++k) {
    pages.push_back(std::make_unique<TcpClient>(server_.port()));
    pages.back()->Send(Asking("GET", Target("/events")));
    listening += pages.back()->Until("\r\n\r\n").starts_with("HTTP/1.1 200") ? 1 : 0;
  }
  EXPECT_EQ(listening, 40);
  EXPECT_THAT(Ask(Asking("POST", Target("/stop"))), StartsWith("HTTP/1.1 202"));
  EXPECT_EQ(stops_, 1);
}

/// Strangers who say half a request, pages that listen and never read, and the one who must be heard.
TEST_F(Live, TwoHundredConnectionsDelayNeitherReadingsNorAStop) {
  server_.Begin("{}");
  std::vector<std::unique_ptr<TcpClient>> pages, strangers;
  for (int k = 0; k < 20; ++k) {
    pages.push_back(std::make_unique<TcpClient>(server_.port()));
    pages.back()->Send(Asking("GET", Target("/events")));
  }
  for (const auto& page : pages) page->Until("event: begin");
  for (int k = 0; k < 180; ++k) {
    strangers.push_back(std::make_unique<TcpClient>(server_.port()));
    strangers.back()->Send("GET / HTTP/1.1\r\nHost: ");
  }
  const std::string reading(400, '1');
  duration<double, std::micro> longest{}, sum{};
  constexpr int kReadings = 4000;
  for (int k = 0; k < kReadings; ++k) {
    const auto begun = steady_clock::now();
    server_.Tell("reading", reading);
    const duration<double, std::micro> took = steady_clock::now() - begun;
    longest = std::max(longest, took);
    sum += took;
    if (k % 40 == 0) std::this_thread::sleep_for(milliseconds(2));
  }
  const auto asked = steady_clock::now();
  EXPECT_THAT(Ask(Asking("POST", Target("/stop"))), StartsWith("HTTP/1.1 202"));
  const duration<double, std::milli> stop_took = steady_clock::duration(stopped_) - asked.time_since_epoch();
  fmt::print("a reading is told in {:.1f} us, the slowest of {} in {:.0f} us; a stop comes through in {:.1f} ms\n",
             sum.count() / kReadings, kReadings, longest.count(), stop_took.count());
  // The figures are the machine's, which may have other things to do; who waited for a client would wait for seconds.
  EXPECT_LT(longest.count(), 2e6);
  EXPECT_LT(stop_took.count(), 2e3);
  EXPECT_EQ(stops_, 1);
}

}  // namespace
}  // namespace twinbench::live
