#pragma once

#include <gmock/gmock.h>

#include "tests/support/kept_text.h"
#include "tests/tools/program.h"
#include "tools/twinbench/program.h"

/// The program `twinbench` without a process of its own: for what it writes and what it ends with.
namespace twinbench::test {

/// Something that is written to a descriptor of this process goes to a file while this lives.
class WrittenTo {
 public:
  WrittenTo(const std::string& path, int descriptor) : descriptor_(descriptor), before_(dup(descriptor)) {
    Flush();
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    dup2(file, descriptor_);
    close(file);
  }
  WrittenTo(const WrittenTo&) = delete;
  WrittenTo& operator=(const WrittenTo&) = delete;
  ~WrittenTo() {
    Flush();
    dup2(before_, descriptor_);
    close(before_);
  }

 private:
  static void Flush() {
    std::cout.flush();
    std::fflush(nullptr);
  }
  int descriptor_, before_;
};

/// As Program, but what is called is called in this process: in its folder, with its streams in files.
class ProgramHere : public Program {
 protected:
  Outcome Call(const std::vector<std::string>& arguments) override {
    std::vector<std::string> words = With({"twinbench"}, arguments);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const std::string out = At("") + ".here.out", err = At("") + ".here.err";
    const std::filesystem::path before = std::filesystem::current_path();
    Outcome outcome;
    {
      const WrittenTo stdout_to(out, STDOUT_FILENO), stderr_to(err, STDERR_FILENO);
      std::filesystem::current_path(At(""));
      outcome.exit_code = tools::Main(static_cast<int>(words.size()), argv.data());
    }
    std::filesystem::current_path(before);
    outcome.out = Contents(out);
    outcome.err = Contents(err);
    return outcome;
  }

  /// Calls what is bad input: code 2, nothing on stdout, one line that says what is expected, the folder as it was.
  std::string Refusal(const std::vector<std::string>& arguments) {
    const auto before = Snapshot();
    Outcome outcome = Call(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err, testing::HasSubstr("; expected "));
    EXPECT_TRUE(before == Snapshot()) << "the folder has changed";
    return outcome.err.substr(0, outcome.err.find('\n'));
  }
  /// @param place  In what is said, which is kept.
  void ExpectRefused(const std::vector<std::string>& arguments, const std::string& place = "") {
    const std::string refusal = Refusal(arguments);
    EXPECT_THAT(refusal, testing::HasSubstr(place));
    EXPECT_KEPT(refusal);
  }

  /// Whoever does not answer shall not be waited for long: every device of bench.toml, for so long.
  void WaitBriefly(const std::string& for_s) const {
    std::string text = Read("bench.toml");
    for (auto at = text.find("]\nkind = \""); at != std::string::npos; at = text.find("]\nkind = \"", at + 2))
      text.insert(at + 2, "timeout_s = " + for_s + "\n");
    Write("bench.toml", text);
  }

  /// What many tests begin with is made by the first of them; the others get a copy of the folder as it was then.
  /// @param name  Of a state of the folder, one in this program.
  void BeginWith(const std::string& name, const std::function<void()>& make) {
    static const TemporaryFolder made;
    const auto all = std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing;
    if (std::filesystem::exists(made.File(name))) return std::filesystem::copy(made.File(name), At(""), all);
    make();
    std::filesystem::copy(At(""), made.File(name), all);
  }
};

/// The same with the small scenario.
class SmallProgram : public ProgramHere {
 protected:
  SmallProgram() { Write("small.toml", kSmall); }
};

}  // namespace twinbench::test
