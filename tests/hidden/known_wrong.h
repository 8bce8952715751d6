#pragma once

#include <gtest/gtest.h>

#include "tests/hidden/judge.h"

/// Cases of the suite's fixed set, and how well they must do.
namespace twinbench::hidden {

/// A case of the suite, answered.
struct Answered {
  std::string set, name;
  bool is_right = false;
  std::string words;  // what is hidden and what was answered, for messages
};
std::vector<Answered> AnsweredOf(const std::vector<Outcome>& outcomes);

/// A case that is answered wrongly today.
struct KnownWrong {
  std::string set, name;
  std::string why;  // in words, never empty
};

/// Lines "set | case | why"; # begins a comment.
/// @throws InputError with the line that is none.
std::vector<KnownWrong> ParseKnownWrong(const std::string& text, const std::string& path);
/// tests/data/known_wrong.txt.
const std::vector<KnownWrong>& KnownWrongCases();

/// Succeeds if exactly those of the cases are wrong that the list has of their sets. What has become right, or is
/// no case any more, must leave the list: so that what is right may only grow.
::testing::AssertionResult WrongOnlyWhereKnown(const std::vector<Answered>& answered,
                                               const std::vector<KnownWrong>& known = KnownWrongCases());

/// The fewest of `of` cases that a pooled rate must reach: so many that a true rate of `caught` fails at least nine
/// times in ten.
int FewestOf(int of, double caught);

/// Of a rate that is claimed, and one that must not pass for it.
/// Fails too if there are so few cases that the claimed rate itself would fail more than once in fifty.
::testing::AssertionResult IsPooledRate(int count, std::size_t of, double claimed, double caught);

/// Two-sided, of a share that is claimed as a number: fails if so uneven a count has a probability below 1 %.
::testing::AssertionResult IsShareOf(int count, std::size_t of, double claimed);

/// Makes, diagnoses and judges every case; the outcomes are in the order of the plans whatever the threads.
std::vector<Outcome> RunReduced(const std::vector<Plan>& plans, int threads = 1);

int CountOf(const std::vector<Outcome>& outcomes, bool (*test)(const Outcome&));

/// The answers that `right` does not hold for, for messages.
std::string Others(const std::vector<Outcome>& outcomes, bool (*right)(const Outcome&));

}  // namespace twinbench::hidden
