#include "tools/twinbench/common_options.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>

namespace twinbench::tools {
namespace {

using SteadyClock = std::chrono::steady_clock;
const SteadyClock::time_point program_began = SteadyClock::now();

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

std::shared_ptr<const Talk> AddTalk(CLI::App& command) {
  auto talk = std::make_shared<Talk>();
  auto* quiet = command.add_flag("--quiet", talk->quiet, "no progress: the answer, warnings and failures only");
  command.add_flag("--verbose", talk->verbose, "the answer in full where there is a short one, and how long it took")->excludes(quiet);
  command.set_version_flag("--version", TWINBENCH_VERSION, "print the program's version and exit");
  return talk;
}

void SayWhatItTook(const std::string& command) {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  fmt::print(stderr, "twinbench {}: {:.1f} s, {:.1f} s of CPU time, {} MB\n", command,
             std::chrono::duration<double>(SteadyClock::now() - program_began).count(), Seconds(used.ru_utime) + Seconds(used.ru_stime), used.ru_maxrss / 1024);
}

CLI::Option* AddOutput(CLI::App& command, std::string& to, const std::string& what, const std::string& also) {
  const auto no_stdout = [](const std::string& path) { return path == "-" ? std::string("what is written here cannot go to stdout") : std::string(); };
  return command.add_option("-o,--output" + also, to, fmt::format("write {} here", what))->check(CLI::Validator(no_stdout, ""));
}

CLI::Option* AddTextOutput(CLI::App& command, std::string& to, const std::string& what, const std::string& also) {
  return command.add_option("-o,--output" + also, to, fmt::format("write {} here, - for stdout", what));
}

void AddSet(CLI::App& command, std::vector<std::string>& overrides) {
  command.add_option("--set", overrides, "override a key of the scenario: procedure.positions=12")->allow_extra_args(false);
}

void AddScenarioOfReadings(CLI::App& command, std::string& scenario) {
  command.add_option("--scenario", scenario, "bench and procedure behind a readings.csv");
}

void AddEstimator(CLI::App& command, std::string& estimator, const std::string& also) {
  command.add_option("--estimator" + also, estimator, "rigorous: weighted least squares (exact model); published: the paper's equations")
      ->check(CLI::IsMember({"published", "rigorous"}))
      ->capture_default_str();
}

void AddThreads(CLI::App& command, int& threads) {
  constexpr int kMost = 4096;
  command.add_option("--threads", threads, "that share the work; the result is the same; left out: one for each core")
      ->check(CLI::Range(1, kMost))
      ->default_str("");
}

}  // namespace twinbench::tools
