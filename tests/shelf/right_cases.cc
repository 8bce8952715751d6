#include "tests/shelf/right_cases.h"

#include "twin/core/errors.h"
#include "twin/core/whole_file.h"

namespace twinbench::shelf {
namespace {

const std::string kPath = TWINBENCH_TEST_DATA "/shelf/right.txt";

constexpr const char* kHead =
    "# Recordings of this folder that are diagnosed rightly today (tests/shelf/judge.h): what is right may only "
    "grow.\n"
    "# Those that take long are marked slow: only tools/scores --set shelf runs them. The list is written anew by\n"
    "# TWINBENCH_ACCEPT_RIGHT=1 build/tests/shelf/test_shelf --gtest_filter='*Recordings*' (=all: slow ones too), "
    "and\n"
    "# whoever commits it reads the difference.\n\n";

}  // namespace

KnownCases ParseKnownCases(const std::string& text, const std::string& path) {
  KnownCases known;
  std::istringstream in(text);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    std::string name, word;
    words >> name;
    Known& one = known[name];
    while (words >> word) {
      if (word != "right" && word != "slow")
        throw InputError(fmt::format("{}:{}", path, number), "is \"" + line + "\"",
                         "a number, then right, slow or both");
      (word == "right" ? one.is_right : one.is_slow) = true;
    }
  }
  return known;
}

std::string InLines(const KnownCases& known) {
  std::string text;
  for (const auto& [name, one] : known) {
    if (one.is_right || one.is_slow)
      text += name + (one.is_right ? " right" : "") + (one.is_slow ? " slow" : "") + "\n";
  }
  return text;
}

KnownCases ReadKnownCases() { return ParseKnownCases(BytesOfFile(kPath), kPath); }

void WriteKnownCases(const KnownCases& known) { WriteFileAtOnce(kPath, kHead + InLines(known)); }

}  // namespace twinbench::shelf
