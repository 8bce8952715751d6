#include "twin/core/toml_bounds.h"

#include <fmt/format.h>

#include <cstring>

#include "twin/core/errors.h"

namespace twinbench {
namespace {

/// Goes through TOML letter by letter and measures what stands between separators; strings count towards a key only if
/// an equals sign follows.
class KeyMeasure {
 public:
  explicit KeyMeasure(const std::string& name) : name_(name) {}

  void Take(char c) {
    if (c == '\n') ++line_;
    if (in_comment_) {
      in_comment_ = c != '\n';
    } else if (quote_ != 0) {
      TakeQuoted(c);
    } else if (c == '"' || c == '\'') {
      quote_ = c;
    } else if (c == '#') {
      in_comment_ = true;
    } else if (std::strchr(",={}[]\n", c) != nullptr) {
      CheckEnded(c);
    } else {
      ++length_;
      parts_ += c == '.' ? 1 : 0;
    }
  }

  void CheckEnded(char by) {
    if (parts_ > kMostParts) Refuse(fmt::format("a key of {} parts", parts_), fmt::format("{}", kMostParts));
    if (by == '=' && length_ > kLongestKey)
      Refuse(fmt::format("a key of {} letters", length_), fmt::format("{}", kLongestKey));
    length_ = 0;
    parts_ = 1;
  }

 private:
  void TakeQuoted(char c) {
    ++length_;
    const bool ends = c == quote_ && !(quote_ == '"' && escaped_);
    escaped_ = c == '\\' && !escaped_;
    if (ends) quote_ = 0;
  }

  [[noreturn]] void Refuse(const std::string& found, const std::string& most) const {
    throw InputError(fmt::format("{}:{}", name_, line_), found, "at most " + most);
  }

  const std::string& name_;
  int line_ = 1, length_ = 0, parts_ = 1;
  char quote_ = 0;
  bool escaped_ = false, in_comment_ = false;
};

}  // namespace

void RequireModestKeys(const std::string& text, const std::string& name) {
  KeyMeasure measure(name);
  for (const char c : text) measure.Take(c);
  measure.CheckEnded('\n');
}

}  // namespace twinbench
