#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "twin/core/errors.h"

namespace twinbench::test {

/// Python with its own library; and Debian's, which alone has what Debian packages for it.
inline constexpr const char *kPlainPython = "python3", *kDebianPython = "/usr/bin/python3";

/// A bench of others: a program in Python under tests/data/foreign_bench/ that shares nothing with this one and is reached by TCP.
/// It ends with this object, and with the test program, by the end of its stdin.
class ForeignBench {
 public:
  /// @param program  "turntable_bench.py".
  /// @param folder   Of what it tells.
  /// @param faults   "controller.mute@3" (tests/data/foreign_bench/line_devices.py).
  ForeignBench(const std::string& program, const std::string& folder, const std::vector<std::string>& faults,
               const std::string& python = kPlainPython) {
    const std::string told = folder + "/foreign.json";
    std::filesystem::remove(told);
    std::vector<std::string> words = {python, "-B", TWINBENCH_TEST_DATA "/foreign_bench/" + program, told};
    words.insert(words.end(), faults.begin(), faults.end());
    Spawn(words);
    constexpr auto kPause = std::chrono::milliseconds(20);
    for (int k = 0; k < 500 && !std::filesystem::exists(told); ++k) std::this_thread::sleep_for(kPause);
    std::ifstream in(told);
    if (!in) throw BenchError(program + " did not come up");
    told_ = nlohmann::json::parse(in);
  }
  ForeignBench(const ForeignBench&) = delete;
  ForeignBench& operator=(const ForeignBench&) = delete;
  ~ForeignBench() {
    close(stdin_);
    waitpid(id_, nullptr, 0);
  }

  /// HOST:PORT.
  std::string Address(const std::string& device) const {
    return "127.0.0.1:" + std::to_string(told_.at("ports").at(device).get<int>());
  }
  /// What is hidden in it, in its own numbers.
  const nlohmann::json& told() const { return told_; }

 private:
  void Spawn(std::vector<std::string>& words) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw BenchError("there is no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    const int failed = posix_spawnp(&id_, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[0]);
    stdin_ = ends[1];
    if (failed == 0) return;
    close(stdin_);
    throw BenchError(words[0] + " cannot be started");
  }

  pid_t id_ = 0;
  int stdin_ = -1;
  nlohmann::json told_;
};

}  // namespace twinbench::test
