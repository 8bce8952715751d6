#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

/// Options that several commands have are hung under them here and nowhere else, so that they mean the same everywhere.
namespace twinbench::tools {

/// How much a command says beside its answer.
struct Talk {
  bool quiet = false, verbose = false;
};

/// `--quiet`, `--verbose` and `--version`, which every command has (AnswerWith).
std::shared_ptr<const Talk> AddTalk(CLI::App& command);

/// What `--verbose` says last: how long the command took.
void SayWhatItTook(const std::string& command);

/// `-o`: where a command writes what it makes, as "the page". A text may go to stdout.
/// @param also  Another name of the option, as it was called first: ",--tables".
CLI::Option* AddOutput(CLI::App& command, std::string& to, const std::string& what, const std::string& also = "");
CLI::Option* AddTextOutput(CLI::App& command, std::string& to, const std::string& what, const std::string& also = "");

void AddSet(CLI::App& command, std::vector<std::string>& overrides);
void AddEstimator(CLI::App& command, std::string& estimator, const std::string& also = "");
void AddThreads(CLI::App& command, int& threads);

/// "; the nearest is --against" where one of the words was probably meant; empty where the word is another one.
std::string OrNearest(const std::string& word, const std::vector<std::string>& words);

/// One of a few words; another is refused with the nearest.
CLI::Validator OneOf(const std::vector<std::string>& words);

/// Numbers without an upper bound: CLI11 says its largest double.
CLI::Validator AboveZero();
CLI::Validator FromZero();

}  // namespace twinbench::tools
