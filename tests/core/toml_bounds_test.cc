#include "twin/core/toml_bounds.h"

#include <gmock/gmock.h>

#include "tests/core/input_error.h"

namespace twinbench {
namespace {

std::string Repeated(const std::string& text, int times) {
  std::string all;
  for (int k = 0; k < times; ++k) all += text;
  return all;
}

std::string BoundsError(const std::string& text) {
  return MessageOf([&] { RequireModestKeys(text, "a.toml"); });
}

TEST(TomlBounds, RefuseKeysOfManyPartsHoweverTheyAreWrittenAndOfManyLetters) {
  constexpr int kMany = 100000;
  for (const char* part : {"a.", "a . ", "\"a\".", "'a'."}) {
    EXPECT_EQ(BoundsError("x = 1\n" + Repeated(part, kMany) + "a = 1\n"),
              "a.toml:2: a key of 100001 parts; expected at most 64")
        << part;
    EXPECT_EQ(BoundsError("[" + Repeated(part, kMany) + "a]\n"),
              "a.toml:1: a key of 100001 parts; expected at most 64");
    EXPECT_EQ(BoundsError("x = {" + Repeated(part, kMany) + "a = 1}"),
              "a.toml:1: a key of 100001 parts; expected at most 64");
  }
  EXPECT_EQ(BoundsError(std::string(200000, 'k') + "= 1"),
            "a.toml:1: a key of 200000 letters; expected at most 1024");
  EXPECT_EQ(BoundsError("[t]\n\"" + std::string(200000, 'k') + "\"= 1"),
            "a.toml:2: a key of 200001 letters; expected at most 1024");
}

TEST(TomlBounds, LetLongValuesAndCommentsPass) {
  const std::string numbers = Repeated("0.125, ", 100000);
  const std::string words = Repeated("a.b.c ", 100000);
  EXPECT_NO_THROW(RequireModestKeys("x = [" + numbers + "]\ny = \"" + words + "\"\n", "a.toml"));
  EXPECT_NO_THROW(RequireModestKeys("# " + words + "\nx = '''\n" + words + "'''\nz = 1", "a.toml"));
  EXPECT_NO_THROW(RequireModestKeys("x = \"an escaped \\\" and a # that is none = " + words + "\"", "a.toml"));
}

}  // namespace
}  // namespace twinbench
