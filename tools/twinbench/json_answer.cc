#include "tools/twinbench/json_answer.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <set>
#include <string_view>

#include "tools/twinbench/common_options.h"
#include "tools/twinbench/exit_code.h"
#include "tools/twinbench/progress.h"
#include "tools/twinbench/run_folder.h"
#include "twin/core/bench_format.h"
#include "twin/core/errors.h"
#include "twin/core/scenario_schema.h"

namespace twinbench::tools {
namespace {

constexpr std::string_view kJson = "--json";

void FlushStdout() {
  std::cout.flush();
  std::fflush(stdout);
}

void WriteAll(int descriptor, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t written = write(descriptor, text.data() + at, text.size() - at);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw BenchError("not all of the answer could be written to stdout");
    at += static_cast<std::size_t>(written);
  }
}

/// Of a scenario, above its tables: "seed".
bool IsTopKey(const std::string& word) {
  Scenario any;
  any.bench = BenchFormats().front()->name;
  return std::ranges::any_of(KeysOf(any), [&](const ScenarioKey& key) { return key.table.empty() && key.Name() == word; });
}

/// The key that a fault is about: "unknown key laser.x", "laser.x is 3", "laser.x: the file ...".
std::string KeyOf(const InputFault& fault) {
  static const std::regex named("^unknown (?:key|table) ([A-Za-z0-9_.]+)"),
      dotted("^([A-Za-z_][A-Za-z0-9_]*(?:\\.[A-Za-z0-9_]+)+)(?:$|:| [a-z])"), option("^(--[a-z-]+)(?: ([A-Za-z0-9_.]+)=.*)?");
  std::smatch match;
  for (const std::regex& pattern : {named, dotted})
    if (std::regex_search(fault.what, match, pattern)) return match[1];
  if (const std::string word = fault.what.substr(0, fault.what.find_first_of(" :")); IsTopKey(word)) return word;
  if (!std::regex_search(fault.where, match, option)) return "";
  return match[2].matched ? match[2] : match[1];
}

void AddPlace(const std::string& where, nlohmann::json& json) {
  static const std::regex with_line("(.*):([0-9]+)");
  std::smatch match;
  if (where.starts_with("--")) return;
  if (std::regex_match(where, match, with_line)) {
    json["file"] = match[1].str();
    json["line"] = std::strtol(match[2].str().c_str(), nullptr, 10);
  } else if (where.find_first_of("./") != std::string::npos) {
    json["file"] = where;
  }
}

const char* KindOf(ExitCode code) {
  switch (code) {
    case kBadInput: return "input";
    case kStateUnknown: return "state_unknown";
    default: return "bench";
  }
}

nlohmann::json Fault(const char* kind, const std::string& message, ExitCode code) {
  return {{"kind", kind}, {"message", message}, {"exit_code", static_cast<int>(code)}};
}

/// Nobody waits at these for a device or a browser: what takes long is computed, and may do so without a word.
bool Computes(const std::string& command) {
  static const std::set<std::string> commands = {"run",  "separate", "score",   "diagnose", "plan",   "budget",
                                                 "uncertainty", "import", "report", "certificate", "compensate"};
  return commands.contains(command);
}

std::string TextOf(const nlohmann::json& json) {
  constexpr int kIndent = 1;
  return json.dump(kIndent, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";  // a file's name may be any bytes
}

}  // namespace

JsonAnswer::JsonAnswer(std::string to, bool verbose) : to_(std::move(to)), verbose_(verbose) {
  if (!IsOnStdout()) return;
  FlushStdout();
  stdout_ = dup(STDOUT_FILENO);
  if (stdout_ < 0 || dup2(STDERR_FILENO, STDOUT_FILENO) < 0) throw BenchError("stdout cannot be kept for the answer");
}

JsonAnswer::~JsonAnswer() {
  if (stdout_ < 0) return;
  FlushStdout();
  dup2(stdout_, STDOUT_FILENO);
  close(stdout_);
}

void JsonAnswer::Write(const nlohmann::json& json) {
  Doing("");
  if (!IsWanted()) return;
  Require(!is_written_, "a command answers once");
  is_written_ = true;
  if (!IsOnStdout()) return WriteFileAtOnce(to_, TextOf(json));
  FlushStdout();
  WriteAll(stdout_, TextOf(json));
}

void AnswerWith(CLI::App& command, const std::string& what, std::function<void(JsonAnswer&)> action) {
  auto to = std::make_shared<std::string>();
  command.add_option(std::string(kJson), *to, "write " + what + " as JSON into this file; - or nothing: to stdout, and all else to stderr")
      ->type_name("[FILE]")
      ->expected(0, 1)
      ->default_str("-");
  const std::string name = command.get_name();
  command.callback([to, name, talk = AddTalk(command), action = std::move(action)] {
    JsonAnswer answer(*to, talk->verbose);
    if (talk->quiet) ShowNoProgress();
    std::optional<StillWorking> patience;
    if (Computes(name)) patience.emplace();
    try {
      action(answer);
      if (talk->verbose) SayWhatItTook(name);
    } catch (const std::exception& error) {
      if (answer.IsOnStdout() && !answer.IsWritten()) answer.Write(FailureJson(error));
      throw;
    }
  });
}

nlohmann::json FailureJson(const std::exception& error) {
  const ExitCode code = ExitCodeOf(error);
  nlohmann::json json = Fault(KindOf(code), error.what(), code);
  if (const auto* input = dynamic_cast<const InputError*>(&error)) {
    const InputFault& fault = input->fault();
    json["message"] = fault.what;
    json["expected"] = fault.expected;
    json["where"] = fault.where;
    AddPlace(fault.where, json);
    if (const std::string key = KeyOf(fault); !key.empty()) json["key"] = key;
  }
  return {{"error", json}};
}

nlohmann::json WrongCommandLineJson(const std::string& message) {
  return {{"error", Fault("command_line", message, kBadInput)}};
}

bool AsksJsonOnStdout(int argc, const char* const* argv) {
  for (int k = 1; k < argc; ++k) {
    const std::string_view word = argv[k];
    if (word == "--json=-") return true;
    if (word == kJson && (k + 1 == argc || argv[k + 1][0] == '-' || !std::string_view(argv[k + 1]).ends_with(".json"))) return true;
  }
  return false;
}

}  // namespace twinbench::tools
