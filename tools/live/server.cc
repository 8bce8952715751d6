#include "tools/live/server.h"

#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/lockfree/spsc_queue.hpp>
#include <chrono>
#include <csignal>
#include <future>
#include <list>
#include <optional>
#include <thread>

#include "tools/live/feed.h"
#include "tools/live/gate.h"
#include "twin/core/secret_token.h"
#include "twin/core/errors.h"

namespace twinbench::live {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::uint32_t kHeader_B = 8 * 1024;  // of a request
constexpr std::uint64_t kBody_B = 1024;        // no request has one
constexpr std::size_t kConnections = 48;
constexpr std::size_t kListeners = 40;         // of them: a stop always finds a place
constexpr auto kRequestWithin = seconds(5);
constexpr auto kIdle = seconds(30);          // between two requests of a connection that has shown the token
constexpr auto kTakenWithin = seconds(10);   // a piece of an answer by the browser
constexpr auto kBeat = seconds(5);           // a page that hears nothing for longer knows that nobody is there
constexpr auto kTick = milliseconds(20);
constexpr std::size_t kPiece_B = 64 * 1024;  // at most that is on its way to a browser
constexpr std::size_t kWaiting = 4096;       // events between measurement and server
constexpr std::size_t kKept = 20000;         // events for pages that come later

struct ToldEvent {
  const char* kind;
  std::string json;
};

/// The policy in the page's markup, which names its script and style by their hashes.
std::string PolicyOf(std::string_view markup) {
  constexpr std::string_view kBefore = "http-equiv=\"Content-Security-Policy\" content=\"";
  const std::size_t found = markup.find(kBefore);
  const std::string strictest = "default-src 'none'; frame-ancestors 'none'";
  if (found == markup.npos) return strictest;
  const std::size_t begin = found + kBefore.size();
  return std::string(markup.substr(begin, markup.find('"', begin) - begin)) + "; frame-ancestors 'none'";
}

/// What all connections share; used by the server's thread alone.
struct Shared {
  Gate gate;
  std::string_view markup;
  std::string policy;
  std::function<void()> stop;
  std::function<void(bool)> pause;
  Feed feed{kKept};
  std::size_t listeners = 0;
};

template <class Body>
void SetHeaders(http::response<Body>& answer, const Shared& shared) {
  answer.set("Content-Security-Policy", shared.policy);
  answer.set(http::field::cache_control, "no-store");
  answer.set("Referrer-Policy", "no-referrer");
  answer.set("X-Content-Type-Options", "nosniff");
  answer.set("Cross-Origin-Resource-Policy", "same-origin");
  answer.set("Cross-Origin-Opener-Policy", "same-origin");
}

class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, Shared& shared) : stream_(std::move(socket)), shared_(shared) {}

  void Read() {
    parser_.emplace();
    parser_->header_limit(kHeader_B);
    parser_->body_limit(kBody_B);
    stream_.expires_after(knows_token_ ? kIdle : kRequestWithin);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](beast::error_code error, std::size_t) { self->Answer(error); });
  }

  /// Sends what is new to a page that listens, and a sign of life where nothing was new for long.
  void Pump() {
    if (!listens_ || writes_ || closed_) return;
    if (!knows_beginning_ && !shared_.feed.begin().empty()) piece_ += shared_.feed.begin(), knows_beginning_ = true;
    piece_ += shared_.feed.From(next_, kPiece_B);
    const auto now = std::chrono::steady_clock::now();
    if (piece_.empty() && now - written_ >= kBeat) piece_ = "event: beat\ndata: null\n\n";
    if (piece_.empty()) return;
    written_ = now;
    Write(asio::buffer(piece_), [self = shared_from_this()] { self->piece_.clear(), self->Pump(); });
  }

  void Close() {
    if (listens_ && !closed_) --shared_.listeners;
    closed_ = true;
    beast::error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_both, ignored);
    stream_.close();
  }

  bool closed() const { return closed_; }
  bool knows_token() const { return knows_token_; }
  bool listens() const { return listens_; }
  bool IsToldAll() const { return closed_ || !listens_ || (!writes_ && next_ >= shared_.feed.end()); }

 private:
  void Answer(beast::error_code error) {
    if (error == http::error::header_limit) return Refuse({431, "the request's header is too long"}, true);
    if (error == http::error::body_limit) return Refuse({413, "the request is too long"}, true);
    if (error) return Close();
    const auto& asked = parser_->get();
    const auto field = [&](auto name) { return std::string(asked[name]); };
    const auto judged = shared_.gate.Judge({std::string(asked.method_string()), std::string(asked.target()),
                                            field(http::field::host), field(http::field::origin),
                                            field("Sec-Fetch-Site"), field("Last-Event-ID")});
    keep_alive_ = asked.keep_alive();
    if (const auto* refused = std::get_if<Refused>(&judged)) return Refuse(*refused, !refused->knew_token);
    knows_token_ = true;
    Grant(std::get<Granted>(judged));
  }

  void Grant(const Granted& granted) {
    if (granted.wish == Wish::kPage) return Send(200, "text/html; charset=utf-8", std::string(shared_.markup));
    if (granted.wish == Wish::kEvents) return Listen(granted.next_event);
    if (granted.wish == Wish::kStop) return PassOn("stop", shared_.stop);
    if (!shared_.pause) return Refuse({409, "what is shown cannot be paused", true}, false);
    const bool pauses = granted.wish == Wish::kPause;
    PassOn(pauses ? "pause" : "resume", [&] { shared_.pause(pauses); });
  }

  /// Passes a wish on and says so to every page.
  void PassOn(const std::string& wish, const std::function<void()>& pass_on) {
    pass_on();
    shared_.feed.Add("asked", "{\"what\":\"" + wish + "\"}");
    Send(202, "text/plain; charset=utf-8", "the program was asked to " + wish + "; what came of it is on the page\n");
  }

  void Refuse(const Refused& refused, bool and_close) {
    keep_alive_ = keep_alive_ && !and_close;
    Send(refused.status, "text/plain; charset=utf-8", refused.why + "\n");
  }

  void Send(int status, const char* type, std::string text) {
    answer_.emplace();
    answer_->result(static_cast<unsigned>(status));
    SetHeaders(*answer_, shared_);
    answer_->set(http::field::content_type, type);
    answer_->keep_alive(keep_alive_);
    answer_->body() = std::move(text);
    answer_->prepare_payload();
    stream_.expires_after(kTakenWithin);
    http::async_write(stream_, *answer_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (error || !self->keep_alive_) return self->Close();
      self->Read();
    });
  }

  /// The answer has no end: events follow it.
  void Listen(std::uint64_t next) {
    if (shared_.listeners >= kListeners) return Refuse({503, "as many pages as there may be are open", true}, true);
    ++shared_.listeners;
    next_ = next;
    http::response<http::empty_body> head{http::status::ok, 11};
    SetHeaders(head, shared_);
    head.set(http::field::content_type, "text/event-stream");
    head.keep_alive(false);
    piece_ = "HTTP/1.1 200 OK\r\n";
    for (const auto& line : head)
      piece_ += std::string(line.name_string()) + ": " + std::string(line.value()) + "\r\n";
    piece_ += "\r\nretry: 1000\n\n";
    listens_ = true;
    WaitForItsEnd();
    Pump();
  }

  /// A page that listens says nothing more; what comes is its end.
  void WaitForItsEnd() {
    stream_.expires_never();
    stream_.async_read_some(asio::buffer(unasked_),
                            [self = shared_from_this()](beast::error_code, std::size_t) { self->Close(); });
  }

  template <class Buffers, class Then>
  void Write(const Buffers& buffers, Then then) {
    writes_ = true;
    stream_.expires_after(kTakenWithin);
    asio::async_write(stream_, buffers,
                      [self = shared_from_this(), then](beast::error_code error, std::size_t) {
                        self->writes_ = false;
                        if (error) return self->Close();
                        then();
                      });
  }

  beast::tcp_stream stream_;
  Shared& shared_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<http::response<http::string_body>> answer_;
  std::array<char, 64> unasked_{};
  std::string piece_;
  std::uint64_t next_ = 0;
  std::chrono::steady_clock::time_point written_{};
  bool knows_token_ = false, knows_beginning_ = false, keep_alive_ = true, listens_ = false, writes_ = false, closed_ = false;
};

/// Only port 0 may find a free one by itself: an address that was asked for is that one or none.
tcp::acceptor Opened(asio::io_context& io, int port) {
  tcp::acceptor acceptor(io);
  const tcp::endpoint here(asio::ip::address_v4::loopback(), static_cast<unsigned short>(port));
  beast::error_code error;
  acceptor.open(here.protocol());
  acceptor.set_option(tcp::acceptor::reuse_address(true));
  acceptor.bind(here, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) throw InputError(fmt::format("--web {}", port), "the port cannot be opened: " + error.message(), "a free one, or 0");
  return acceptor;
}

}  // namespace

struct Server::State {
  explicit State(Settings settings) : acceptor(Opened(io, settings.port)), tick(io) {
    shared.gate = {NewToken(), acceptor.local_endpoint().port()};
    shared.markup = settings.markup;
    shared.policy = PolicyOf(settings.markup);
    shared.stop = std::move(settings.stop);
    shared.pause = std::move(settings.pause);
    Accept();
    Tick();
  }

  /// Signals are for the thread that measures.
  void Start() {
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    thread = std::thread([this] { Work(); });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }

  /// What goes wrong here ends the page and nothing else.
  void Work() noexcept {
    try {
      io.run();
    } catch (...) {
      is_dead = true;
    }
  }

  void Accept() {
    acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
      if (!error) Welcome(std::move(socket));
      if (acceptor.is_open()) Accept();
    });
  }

  /// Strangers make room, the oldest first, then whoever has shown the token and rests between two requests. A page
  /// that listens is never sent away.
  void Welcome(tcp::socket socket) {
    connections.remove_if([](const auto& c) { return c->closed(); });
    if (connections.size() >= kConnections) {
      auto leaves = std::ranges::find_if(connections, [](const auto& c) { return !c->knows_token(); });
      if (leaves == connections.end())
        leaves = std::ranges::find_if(connections, [](const auto& c) { return !c->listens(); });
      (*leaves)->Close();
      connections.erase(leaves);
    }
    connections.push_back(std::make_shared<Connection>(std::move(socket), shared));
    connections.back()->Read();
  }

  void Tick() {
    TakeWhatWasTold();
    for (const auto& connection : connections) connection->Pump();
    if (is_finishing && IsAllTold()) all_told.set_value(), is_finishing = false;
    tick.expires_after(kTick);
    tick.async_wait([this](beast::error_code error) {
      if (!error) Tick();
    });
  }

  void TakeWhatWasTold() {
    ToldEvent* told = nullptr;
    while (queue.pop(told)) {
      const std::unique_ptr<ToldEvent> owned(told);
      if (owned->kind == kBeginning) shared.feed.Begin(owned->json);
      else shared.feed.Add(owned->kind, owned->json);
    }
    if (const std::uint64_t lost = left_out.exchange(0)) shared.feed.Add("left_out", std::to_string(lost));
  }

  bool IsAllTold() const {
    return std::ranges::all_of(connections, [](const auto& c) { return c->IsToldAll(); });
  }

  void Push(const char* kind, const std::string& json) {
    auto told = std::make_unique<ToldEvent>(ToldEvent{kind, json});
    if (queue.push(told.get())) told.release();
    else ++left_out;
  }

  static constexpr const char* kBeginning = "begin";
  asio::io_context io{1};
  tcp::acceptor acceptor;
  asio::steady_timer tick;
  Shared shared;
  std::list<std::shared_ptr<Connection>> connections;
  boost::lockfree::spsc_queue<ToldEvent*, boost::lockfree::capacity<kWaiting>> queue;
  std::atomic<std::uint64_t> left_out{0};
  std::atomic<bool> is_dead{false};
  std::promise<void> all_told;
  bool is_finishing = false;
  std::thread thread;
};

Server::Server(Settings settings) : state_(std::make_unique<State>(std::move(settings))) {
  state_->Start();
}

Server::~Server() {
  state_->io.stop();
  state_->thread.join();
  state_->connections.clear();
  state_->TakeWhatWasTold();
}

int Server::port() const {
  return state_->shared.gate.port;
}

std::string Server::address() const {
  return fmt::format("http://127.0.0.1:{}/?token={}", port(), state_->shared.gate.token);
}

void Server::Begin(const std::string& json) {
  state_->Push(State::kBeginning, json);
}

void Server::Tell(const char* kind, const std::string& json) {
  state_->Push(kind, json);
}

void Server::Post(const char* kind, const std::string& json) {
  asio::post(state_->io, [this, kind, json] { state_->shared.feed.Add(kind, json); });
}

void Server::Finish() {
  if (state_->is_dead) return;
  std::future<void> told = state_->all_told.get_future();
  asio::post(state_->io, [this] { state_->is_finishing = true; });
  told.wait_for(seconds(1));
}

}  // namespace twinbench::live
