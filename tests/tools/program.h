#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/core/input_error.h"

/// The program `twinbench` as its users meet it: a process in a folder.
namespace twinbench::test {

inline std::vector<std::string> With(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

struct Outcome {
  int exit_code = -1;
  std::string out, err;
};

/// A running twinbench. One that was not waited for is killed.
class Process {
 public:
  /// @param folder  Working directory; what the process says goes to files beside it.
  /// @param name    Of those files: one for each process that runs at the same time.
  Process(const std::string& folder, const std::vector<std::string>& arguments, const std::string& name = "")
      : out_(folder + name + ".out"), err_(folder + name + ".err") {
    std::vector<std::string> words = With({TWINBENCH_PROGRAM}, arguments);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    for (const auto& [descriptor, path] : {std::pair{1, out_}, std::pair{2, err_}})
      posix_spawn_file_actions_addopen(&actions, descriptor, path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (posix_spawn(&id_, TWINBENCH_PROGRAM, &actions, nullptr, argv.data(), environ) != 0)
      throw BenchError("the program cannot be started");
    posix_spawn_file_actions_destroy(&actions);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (id_ > 0) Kill();
    std::filesystem::remove(out_);
    std::filesystem::remove(err_);
  }

  bool Runs() { return id_ > 0 && waitpid(id_, &status_, WNOHANG) == 0 ? true : (id_ = 0, false); }

  /// Whole lines that it has written to stderr up to now; its progress, while it runs.
  std::ptrdiff_t ProgressLines() const {
    const std::string text = Contents(err_);
    return std::count(text.begin(), text.end(), '\n');
  }

  /// Waits for so many of them, or its end.
  void Await(int lines) {
    while (Runs() && ProgressLines() < lines) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  void Kill() {
    kill(id_, SIGKILL);
    Wait();
  }
  void Signal(int signal) { kill(id_, signal); }
  Outcome Wait() {
    if (id_ > 0) waitpid(id_, &status_, 0);
    id_ = 0;
    return {WIFEXITED(status_) ? WEXITSTATUS(status_) : -1, Contents(out_), Contents(err_)};
  }

 private:
  std::string out_, err_;
  pid_t id_ = 0;
  int status_ = 0;
};

/// A working directory with a small scenario, gone at the end of the test.
class Program : public ::testing::Test {
 protected:
  Program() { std::filesystem::create_directory(folder_); }

  virtual Outcome Call(const std::vector<std::string>& arguments) { return Process(folder_, arguments).Wait(); }

  /// Calls what must succeed. @return what it printed to stdout.
  std::string Succeed(const std::vector<std::string>& arguments) {
    const Outcome outcome = Call(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.out;
  }
  nlohmann::json Json(const std::vector<std::string>& arguments) { return nlohmann::json::parse(Succeed(arguments)); }
  nlohmann::json JsonIn(const std::string& name) const { return nlohmann::json::parse(Read(name)); }
  /// It ended with this code and says all of this to stderr.
  static void ExpectEnded(const Outcome& outcome, int code, const std::vector<std::string>& said = {}) {
    EXPECT_EQ(outcome.exit_code, code) << outcome.err;
    for (const std::string& words : said) EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  }

  /// The working directory for "".
  std::string At(const std::string& name) const { return name.empty() ? folder_ : folder_ + "/" + name; }
  std::string Read(const std::string& name) const { return Contents(At(name)); }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(At(name), std::ios::binary) << text;
  }
  bool Exists(const std::string& name) const { return std::filesystem::exists(At(name)); }

  /// Everything in the folder with its content, by name.
  std::map<std::string, std::string> Snapshot() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
      files[entry.path()] = entry.is_regular_file() ? Contents(entry.path()) : "";
    return files;
  }

  /// Runs the small scenario into `name`.
  void MakeRun(const std::string& name, const std::vector<std::string>& options = {}) {
    Succeed(With({"run", "small.toml", "-o", name}, options));
  }
  std::string ReadingsOf(const std::string& run) { return Succeed({"export", run}); }

  static constexpr const char* kSmall = R"(bench = "rotary_4dof"
seed = 5
[target.random]
ex_arcsec = 4.0
ez_arcsec = 5.0
dy_um = 2.0
[reference.random]
ey_arcsec = 5.0
ez_arcsec = 12.0
dy_um = 2.0
[reference.seating]
ez_arcsec = 20.0
[mechanics]
fidelity = "kinematic"
[procedure]
positions = 12
shifts = [0, 1, 5]
passes = [1, -1]
)";

 private:
  TemporaryFolder temporary_;
  std::string folder_ = temporary_.File("work");
};

}  // namespace twinbench::test
