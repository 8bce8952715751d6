#pragma once

#include <gmock/gmock.h>

#include "tests/support/kept_text.h"

namespace twinbench {

/// A text that must be refused, and the line of its file that is to be named (0: none).
struct Refused {
  int line;
  std::string text;
};

/// Demands that each is refused at its line; what is said stands in tests/data/texts.txt.
/// @param message_of  What is said of a text: MessageOf.
inline void ExpectRefused(const std::string& file, const std::function<std::string(const std::string&)>& message_of,
                          const std::vector<Refused>& cases) {
  for (const Refused& refused : cases) {
    const std::string message = message_of(refused.text);
    const std::string line = refused.line > 0 ? std::to_string(refused.line) + ": " : "";
    EXPECT_THAT(message, testing::StartsWith(file + ":" + line)) << refused.text;
    EXPECT_KEPT(message);
  }
}

}  // namespace twinbench
