#include "tools/twinbench/terminal.h"

#include <gtest/gtest.h>

namespace twinbench::tools {
namespace {

TEST(ForTerminal, LeavesNothingThatATerminalObeys) {
  EXPECT_EQ(ForTerminal("\033]0;title\007\033[2J"), "?]0;title??[2J");
  EXPECT_EQ(ForTerminal("a\xC2\x9B" "31mb\r\x7F"), "a?31mb??");
  EXPECT_EQ(ForTerminal("line\n\tµm ± °"), "line\n\tµm ± °");
}

}  // namespace
}  // namespace twinbench::tools
