#include "tests/support/kept_text.h"

#include <sys/file.h>

#include <fstream>
#include <regex>

namespace twinbench::test {
namespace {

using Texts = std::map<std::string, std::vector<std::string>>;  // by test

const std::string kFile = std::string(TWINBENCH_TEST_DATA) + "/texts.txt";
constexpr const char* kHead = "= ";  // "= Suite.Test", then "- " before a text and "  " before its further lines
constexpr const char* kFirst = "- ";
constexpr const char* kFurther = "  ";

Texts Load() {
  Texts all;
  std::vector<std::string>* texts = nullptr;
  std::ifstream file(kFile);
  for (std::string line; std::getline(file, line);) {
    const std::string mark = line.substr(0, 2), rest = line.size() > 2 ? line.substr(2) : "";
    if (mark == kHead) texts = &all[rest];
    if (mark == kFirst) texts->push_back(rest);
    if (mark == kFurther) texts->back() += "\n" + rest;
  }
  return all;
}

void Save(const Texts& all) {
  std::ofstream file(kFile);
  file << "# What people are told, by the tests that ask for it: tests/support/kept_text.h\n";
  for (const auto& [test, texts] : all) {
    file << "\n" << kHead << test << "\n";
    for (const std::string& text : texts)
      file << kFirst << std::regex_replace(text, std::regex("\n"), std::string("\n") + kFurther) << "\n";
  }
}

/// Programs of tests run side by side.
class Lock {
 public:
  Lock() : file_(open(kFile.c_str(), O_RDWR | O_CREAT, 0644)) { flock(file_, LOCK_EX); }
  ~Lock() { close(file_); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  int file_;
};

/// What a test has said until now. At its end nothing that is kept of it may be left.
class OfTest : public testing::EmptyTestEventListener {
 public:
  static OfTest& Running() {
    static OfTest* of_test = [] {
      auto* made = new OfTest;  // gtest's own from here on
      testing::UnitTest::GetInstance()->listeners().Append(made);
      return made;
    }();
    return *of_test;
  }

  testing::AssertionResult Hear(const std::string& text) {
    said_.push_back(text);
    if (accepts_) return testing::AssertionSuccess();
    const auto kept = all_.find(Name());
    if (kept == all_.end() || kept->second.size() < said_.size())
      return testing::AssertionFailure() << "nothing is kept for this text (tests/support/kept_text.h):\n" << text;
    const std::string& expected = kept->second[said_.size() - 1];
    if (expected == text) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "said:\n" << text << "\nkept in tests/data/texts.txt:\n" << expected;
  }

 private:
  static std::string Name() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    return std::string(test->test_suite_name()) + "." + test->name();
  }

  void OnTestEnd(const testing::TestInfo& test) override {
    if (test.result()->Skipped()) return said_.clear();
    const auto kept = all_.find(Name());
    if (accepts_) {
      Accept();
    } else if (kept != all_.end() && !testing::Test::HasFailure()) {
      EXPECT_EQ(kept->second.size(), said_.size()) << "texts that are kept and not said: tests/data/texts.txt";
    }
    said_.clear();
  }

  void Accept() const {
    const Lock lock;
    Texts all = Load();
    if (said_.empty()) all.erase(Name());
    else all[Name()] = said_;
    Save(all);
  }

  const bool accepts_ = std::getenv("TWINBENCH_ACCEPT");
  const Texts all_ = Load();
  std::vector<std::string> said_;
};

}  // namespace

testing::AssertionResult IsKept(const std::string& text) {
  static const std::regex folder("[^\\s'\"(]*twinbench_test_\\w{6}"), source(TWINBENCH_SOURCE_DIR);
  return OfTest::Running().Hear(std::regex_replace(std::regex_replace(text, folder, "<folder>"), source, "<source>"));
}

}  // namespace twinbench::test
