#include "hw_bridge/program/program_run.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <thread>

#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kLook = std::chrono::milliseconds(20);
constexpr auto kMercy = std::chrono::seconds(5);  // between asking it to end and ending it

std::string PutIn(std::string word, const std::map<std::string, std::string>& places) {
  for (const auto& [name, path] : places) {
    const std::string place = "{" + name + "}";
    for (std::size_t at = word.find(place); at != std::string::npos; at = word.find(place, at + path.size()))
      word.replace(at, place.size(), path);
  }
  return word;
}

/// A child that leads a process group of its own, so that what it starts ends with it.
class Child {
 public:
  Child(const std::vector<std::string>& words, const std::string& folder) : name_(words.front()) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    const int error = posix_spawnp(&id_, arguments.front(), &actions, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (error != 0) throw BenchError(fmt::format("{} cannot be started: {}", name_, std::strerror(error)));
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (!has_ended_) End();
  }

  bool HasEnded() {
    if (!has_ended_) has_ended_ = waitpid(id_, &status_, WNOHANG) == id_;
    return has_ended_;
  }

  /// Asks the whole group to end, and ends what has not after a while.
  void End() {
    kill(-id_, SIGTERM);
    const auto until = Clock::now() + kMercy;
    while (!HasEnded() && Clock::now() < until) std::this_thread::sleep_for(kLook);
    kill(-id_, SIGKILL);
    if (!has_ended_) has_ended_ = waitpid(id_, &status_, 0) == id_;
  }

  void RequireSuccess() const {
    if (WIFSIGNALED(status_)) throw BenchError(fmt::format("{} was ended by signal {}", name_, WTERMSIG(status_)));
    if (WEXITSTATUS(status_) != 0)
      throw BenchError(fmt::format("{} ended with code {}", name_, WEXITSTATUS(status_)));
  }

 private:
  std::string name_;
  pid_t id_ = 0;
  int status_ = 0;
  bool has_ended_ = false;
};

}  // namespace

void RunProgram(const ProgramFile& file, const std::map<std::string, std::string>& places,
                const std::function<bool()>& stop_asked) {
  std::vector<std::string> words;
  for (const std::string& word : file.command) words.push_back(PutIn(word, places));
  const std::filesystem::path folder = std::filesystem::absolute(file.path).parent_path();
  Child child(words, folder.string());
  const auto until = Clock::now() + std::chrono::duration<double>(file.timeout_s);
  while (!child.HasEnded()) {
    std::this_thread::sleep_for(kLook);
    const bool is_stopped = stop_asked && stop_asked();
    if (!is_stopped && Clock::now() < until) continue;
    if (child.HasEnded()) break;
    child.End();
    throw BenchError(is_stopped
                         ? fmt::format("{} was stopped by the operator", words.front())
                         : fmt::format("{} took longer than {:g} s and was ended", words.front(), file.timeout_s));
  }
  child.RequireSuccess();
}

}  // namespace twinbench::hw
