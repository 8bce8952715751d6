#pragma once

#include "tests/tools/program_here.h"

namespace twinbench::test {

/// `twinbench serve` and `twinbench measure` as two programs that only share a network.
class ServedProgram : public ProgramHere {
 protected:
  /// @param name  Of the scenario, which is small.toml and carried out by `run` into the folder of that name.
  ServedProgram(const std::string& name, const std::string& scenario) {
    BeginWith(name, [&] {
      Write("small.toml", scenario);
      Succeed({"run", "small.toml", "-o", "run"});
    });
    readings_ = ReadingsOf("run");
  }

  /// Of tests/data/machine/.
  static std::string ServedScenario(const std::string& name) {
    return Contents(TWINBENCH_TEST_DATA "/machine/served_" + name + ".toml");
  }

  /// Starts a server and waits until it has said where it is.
  std::unique_ptr<Process> Serve(const std::vector<std::string>& options = {"--speed", "max"},
                                 const std::string& scenario = "small.toml") {
    const std::vector<std::string> words = {"serve",      scenario, "--iiod-port",   "0",         "--scpi-port", "0",
                                            "--esp-port", "0",      "--write-bench", "bench.toml"};
    std::filesystem::remove(At("bench.toml"));
    auto server = std::make_unique<Process>(At(""), With(words, options), "server");
    for (int k = 0; k < 500 && !Exists("bench.toml"); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_TRUE(Exists("bench.toml")) << "the server did not come up";
    return server;
  }

  /// Goes on where there is a run.
  std::vector<std::string> Measure(const std::string& name) const {
    std::vector<std::string> words = {"measure", "small.toml", "--bench", "bench.toml", "-o", name};
    if (Exists(name)) words.push_back("--resume");
    return words;
  }
  /// Carries something out. That a fit does not describe what is hidden in it is said, with exit code 2.
  std::string Succeed(const std::vector<std::string>& arguments) {
    const Outcome outcome = Call(arguments);
    const bool is_misfit = outcome.exit_code == 2 && outcome.err.find("the fit does not describe the readings") != std::string::npos;
    EXPECT_TRUE(outcome.exit_code == 0 || is_misfit) << outcome.err;
    return outcome.out;
  }
  void Replay(const std::string& record, const std::string& name) {
    Write("replay.toml", "kind = \"replay\"\nrecord = \"" + record + "\"\n");
    Succeed({"measure", "small.toml", "--bench", "replay.toml", "-o", name});
  }
  /// What `run` makes, and nobody at a real bench knows the truth.
  void ExpectAsRun(const std::string& name) {
    EXPECT_EQ(ReadingsOf(name), readings_) << name;
    EXPECT_EQ(Read(name + "/results.json"), Read("run/results.json"));
    EXPECT_FALSE(Exists(name + "/truth.json"));
  }

  std::string readings_;
};

}  // namespace twinbench::test
