#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hw_bridge/control/dialogue_words.h"
#include "hw_bridge/control/line_link.h"

namespace twinbench::hw {

/// The conversation with one controller; several devices may take part in it.
///
/// After any failure the connection is closed, so that a late answer can never be taken for another. The next call
/// opens it again, waiting longer and longer between attempts up to its patience, and asks who is there: it must be
/// the one from before. On a serial line, which outlives its connections, old answers are read away first.
class Dialogue {
 public:
  /// @param identity_query  "*IDN?", "VE?"; empty: it does not tell who it is, and nobody asks.
  /// @param identity        What its answer must begin with.
  Dialogue(Address address, std::string identity_query, std::string identity);
  /// What lines look like on this connection, where they do not end in LF.
  void Speak(const LineWords& line) { line_ = line; }
  /// Said to whoever has been identified, after every opening: commands, each with a query of its error that must be answered by "0,...".
  void IntroduceBy(std::vector<std::string> introductions) { introductions_ = std::move(introductions); }
  /// The identity query is a greeting, before which nobody is heard.
  void HearsGreetedOnly() { hears_greeted_only_ = true; }

  /// Opens the connection unless it is open.
  /// @param device  Whose call it is, for messages.
  /// @throws DeviceFault kTimeout, kDropped, kIdentity.
  void Open(const std::string& device, Duration patience);

  /// Makes sure that a word which cannot wait goes out before anything else that is said from here on: at once behind a new
  /// opening, before anybody is identified (with a greeting before it that it does not wait for, where one is needed), and where an
  /// answer lies about that nobody asked for. Where the conversation is in order nothing is sent.
  /// @param word  With its end; it is not answered.
  /// @throws DeviceFault as Open.
  void SayFirst(const std::string& word, const std::string& device, Duration patience);

  /// Sends `text`, lines with their ends, and returns the line that comes back.
  /// @param meanwhile  Called every 50 ms until it comes; what it throws leaves the answer to nobody.
  /// @throws DeviceFault kTimeout, kDropped, kProtocol, and what Open throws.
  std::string Ask(const std::string& device, const std::string& text, Duration patience, const std::function<void()>& meanwhile = {});
  /// Sends `text`, which is not answered.
  void Tell(const std::string& device, const std::string& text, Duration patience);
  /// Takes one more line, of an answer that has several.
  std::string NextLine(const std::string& device, Duration patience, const std::function<void()>& meanwhile = {});

  void Close() { link_.reset(); }
  /// How many times the connection was opened: what a device had set may be gone when it has grown.
  int openings() const { return openings_; }
  /// The full answer to the identity query.
  const std::string& identity() const { return identity_; }
  const Address& address() const { return address_; }

 private:
  void Connect(const std::string& device, Duration patience);
  /// @param is_greeted  The identity query has been said.
  void Meet(const std::string& device, Duration patience, bool is_greeted = false);
  void ReadOldAnswersAway(Duration patience);
  void Identify(const std::string& device, Duration patience, bool is_greeted);
  void Introduce(const std::string& device, const std::string& introduction, Duration patience);
  LinkResult ReadLine(Duration patience, const std::function<void()>& meanwhile);
  std::string AwaitIdentity(const std::string& device, Duration patience);
  void Send(const std::string& device, const std::string& text, Duration patience);
  [[noreturn]] void Fail(FaultKind kind, const std::string& device, const std::string& why);
  bool IsSerial() const { return address_.kind == Address::Kind::kSerial; }
  bool IsExpected(const std::string& answer) const;

  Address address_;
  std::string identity_query_;
  std::string identity_;         // as much as is known of it
  bool identity_known_ = false;  // all of it
  bool hears_greeted_only_ = false;
  std::vector<std::string> introductions_;
  LineWords line_;
  std::unique_ptr<LineLink> link_;
  int openings_ = 0;
};

}  // namespace twinbench::hw
