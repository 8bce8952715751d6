#pragma once

#include <string>
#include <vector>

#include "twin/core/devices.h"

/// The words of device calls. Private to device_call.cc, machine_call.cc, asked_bench.cc, asked_machine.cc and sample_text.cc.
namespace twinbench {

/// Words and numbers with blanks between them; numbers in the shortest form that comes back to the same bits.
class CallWords {
 public:
  CallWords& operator<<(const std::string& word);
  CallWords& operator<<(double number);
  CallWords& operator<<(std::int64_t number);
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Takes such a text apart again.
class CallReader {
 public:
  explicit CallReader(const std::string& text);
  /// @throws InputError if there is no further word, or it is no number.
  std::string Word();
  double Number();
  std::int64_t Integer();
  /// All that is left, blanks and all.
  std::string Rest();
  bool AtEnd() const { return at_ >= text_.size(); }

 private:
  const std::string& text_;
  std::size_t at_ = 0;
};

std::string StateText(const TableState& state);
TableState ParseState(const std::string& text);
std::string BlockText(const Acquisition& block);

}  // namespace twinbench
