#pragma once

#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

/// `--json` of every command: what it answers to programs, as one JSON document.
namespace twinbench::tools {

/// Where the document of one command goes.
class JsonAnswer {
 public:
  /// @param to       Empty: nobody asked; "-": stdout, and what is printed while this lives goes to stderr; else a file.
  /// @param verbose  Whether the text beside it shall be in full.
  explicit JsonAnswer(std::string to = "", bool verbose = false);
  ~JsonAnswer();
  JsonAnswer(const JsonAnswer&) = delete;
  JsonAnswer& operator=(const JsonAnswer&) = delete;

  const std::string& to() const { return to_; }
  bool IsWanted() const { return !to_.empty(); }
  bool IsOnStdout() const { return to_ == "-"; }
  bool verbose() const { return verbose_; }
  /// Nothing where nobody asked. Once: a second document is no answer any more.
  /// @throws BenchError if a disk or pipe refuses.
  void Write(const nlohmann::json& json);
  bool IsWritten() const { return is_written_; }

 private:
  std::string to_;
  bool verbose_ = false;
  int stdout_ = -1;  // descriptor of what was stdout
  bool is_written_ = false;
};

/// Hangs the action under a command, with `--json`, `--quiet`, `--verbose` and `--version`. Where the answer goes to stdout and the action throws before it has written one, the
/// failure is the answer (FailureJson).
/// @param what  The command writes: "the score".
void AnswerWith(CLI::App& command, const std::string& what, std::function<void(JsonAnswer&)> action);

/// {"error": {"kind", "message", "exit_code"}}; of an input also "where", "expected" and, as far as it is about one, "file", "line" and
/// "key": the key of a scenario or bench file, or the option.
nlohmann::json FailureJson(const std::exception& error);

/// The same of a command line that says nothing which could be carried out.
nlohmann::json WrongCommandLineJson(const std::string& message);

/// Whether a command line that could not be read to its end asks for the answer on stdout.
bool AsksJsonOnStdout(int argc, const char* const* argv);

}  // namespace twinbench::tools
