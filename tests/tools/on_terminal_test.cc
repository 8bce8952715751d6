#include <gmock/gmock.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "tests/tools/program.h"

/// The program on a terminal, and into a pipe: colour and lines that are rewritten are for the first alone.
namespace twinbench::test {
namespace {

using testing::HasSubstr, testing::Not;

constexpr const char* kEscape = "\033";

class OnTerminal : public Program {
 protected:
  /// All that it writes to a terminal of its own.
  /// @param set  "NO_COLOR=1", one more in its environment.
  std::string Seen(const std::vector<std::string>& arguments, const char* set) {
    int terminal = -1;
    const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
    if (child == 0) {
      setenv("TERM", "xterm", 1);
      unsetenv("NO_COLOR");
      putenv(const_cast<char*>(set));
      std::vector<char*> words = {const_cast<char*>(TWINBENCH_PROGRAM)};
      for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
      words.push_back(nullptr);
      if (chdir(At("").c_str()) == 0) execv(TWINBENCH_PROGRAM, words.data());
      _exit(127);
    }
    std::string text;
    char piece[4096];
    for (ssize_t n = 0; (n = read(terminal, piece, sizeof piece)) > 0;) text.append(piece, static_cast<std::size_t>(n));
    close(terminal);
    int status = 0;
    waitpid(child, &status, 0);
    return text;
  }
};

TEST_F(OnTerminal, AFailureIsRedUnlessColourIsUnwanted) {
  EXPECT_THAT(Seen({"check", "none.toml"}, "NO_COLOR="), HasSubstr("\033[31mtwinbench: none.toml")) << "empty is as if it were not there";
  EXPECT_THAT(Seen({"check", "none.toml"}, "NO_COLOR=1"), Not(HasSubstr(kEscape)));
  EXPECT_THAT(Seen({"check", "none.toml"}, "TERM=dumb"), Not(HasSubstr(kEscape)));
  EXPECT_THAT(Call({"check", "none.toml"}).err, Not(HasSubstr(kEscape)));
}

TEST_F(OnTerminal, ProgressIsOneLineWithTheTimeLeft) {
  Write("small.toml", kSmall);
  EXPECT_THAT(Seen({"run", "small.toml", "-o", "seen"}, "NO_COLOR=1"), testing::ContainsRegex("\r\033.K *124 of 124 readings, .*, bench time [0-9:]+, 0:00 left"));
  const Outcome piped = Call({"run", "small.toml", "-o", "piped"});
  EXPECT_THAT(piped.err, Not(HasSubstr(kEscape)));
  EXPECT_THAT(piped.err, HasSubstr("124 of 124 readings")) << "a line each tenth";
}

TEST_F(OnTerminal, WhatTakesLongSaysWhatItDoesAndLeavesNoTraceOfIt) {
  Write("small.toml", kSmall);
  const std::string seen = Seen({"plan", "small.toml", "--cpu", "3"}, "NO_COLOR=1");
  EXPECT_THAT(seen, testing::ContainsRegex("\r\033.K[a-z].*, 0:0[1-9]\r\033.K"));
  EXPECT_THAT(Call({"plan", "small.toml", "--cpu", "0.5"}).err, Not(HasSubstr(kEscape)));
}

}  // namespace
}  // namespace twinbench::test
