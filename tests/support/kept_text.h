#pragma once

#include <gtest/gtest.h>

namespace twinbench::test {

/// Compares what people are told with tests/data/texts.txt, which keeps all such texts in order under the names of the tests that ask
/// for them. Words are changed there, in one place: TWINBENCH_ACCEPT=1 and a test's program write what is said today, and whoever
/// commits it reads the difference. What a script relies on (exit codes, keys, files) is asserted in the test.
/// @param text  Folders that go with the test, and the tree's own, are kept as <folder> and <source>.
testing::AssertionResult IsKept(const std::string& text);

}  // namespace twinbench::test

#define EXPECT_KEPT(text) EXPECT_TRUE(::twinbench::test::IsKept(text))
