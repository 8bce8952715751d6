#include "tools/twinbench/common_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <iostream>

#include "twin/core/nearest_key.h"

namespace twinbench::tools {
namespace {

const auto program_began = std::chrono::steady_clock::now();

CLI::Validator NumberWhere(bool (*is_allowed)(double), const std::string& expected) {
  const auto check = [is_allowed, expected](const std::string& text) {
    double value = 0.0;
    const bool is_number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
    return is_number && is_allowed(value) ? std::string() : fmt::format("\"{}\" is not allowed; expected {}", text, expected);
  };
  return CLI::Validator(check, "");
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
  const double real_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - program_began).count();
  std::cout.flush();  // of an answer that is still on its way, where both go to one place
  fmt::print(stderr, "twinbench {}: {:.1f} s, {:.1f} s of CPU time\n", command, real_s, static_cast<double>(std::clock()) / CLOCKS_PER_SEC);
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

void AddEstimator(CLI::App& command, std::string& estimator, const std::string& also) {
  command.add_option("--estimator" + also, estimator, "rigorous: weighted least squares (exact model); published: the paper's equations")
      ->check(OneOf({"published", "rigorous"}))
      ->capture_default_str();
}

void AddThreads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "that share the work; the result is the same; left out: one for each core")->check(CLI::Range(1, 4096))->default_str("");
}

std::string OrNearest(const std::string& word, const std::vector<std::string>& words) {
  const std::string nearest = Nearest(word, words);
  return 2 * EditDistance(word, nearest) + 2 <= static_cast<int>(word.size()) ? "; the nearest is " + nearest : "";
}

CLI::Validator OneOf(const std::vector<std::string>& words) {
  const auto check = [words](const std::string& word) {
    if (std::ranges::find(words, word) != words.end()) return std::string();
    return fmt::format("there is no \"{}\" among {}{}", word, fmt::join(words, ", "), OrNearest(word, words));
  };
  return CLI::Validator(check, fmt::format("{{{}}}", fmt::join(words, ",")));
}

CLI::Validator AboveZero() {
  return NumberWhere([](double value) { return value > 0.0; }, "a number above 0");
}

CLI::Validator FromZero() {
  return NumberWhere([](double value) { return value >= 0.0; }, "0 or a number above it");
}

}  // namespace twinbench::tools
