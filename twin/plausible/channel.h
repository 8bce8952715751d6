#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "twin/core/bench_format.h"
#include "twin/core/reading.h"

namespace twinbench::plausible {

inline constexpr std::size_t kFewestToJudge = 12;  // values of a channel

/// One column of numbers, those that are there.
struct Channel {
  const ReadingColumn* column = nullptr;
  std::vector<const Reading*> reading;
  std::vector<double> value;  // SI

  std::size_t size() const { return value.size(); }
};

double ValueOf(const ReadingColumn& column, const Reading& reading);
Channel ChannelOf(const std::vector<Reading>& readings, const ReadingColumn& column);
std::vector<Channel> ShownChannels(const std::vector<Reading>& readings, const BenchFormat& bench);

/// A value as the file has it, with the column's name.
std::string Text(const ReadingColumn& column, double value);

bool Moves(const Channel& channel);

/// The step of which all values are multiples; 0 if there is none.
double StepOf(const Channel& channel);

/// What values differ by no less than, for any reason but the digits that they were written or computed with: below it there is no
/// scatter, and nothing lies any times of it away.
double LeastScatterOf(const Channel& channel);

/// Without their signs.
std::vector<double> Sizes(std::vector<double> x);

/// The middle one; 0 of none.
double MiddleOf(std::vector<double> x);

/// Two readings, by their places in the channel.
using Pair = std::pair<std::size_t, std::size_t>;
/// Readings that follow each other in one pass.
std::vector<Pair> Neighbours(const Channel& channel);
/// Readings of one position of a set-up, each with the one before.
std::vector<Pair> Repeats(const Channel& channel);
/// What lies between the readings of each pair: the second less the first.
std::vector<double> Between(const std::vector<Pair>& pairs, const std::vector<double>& value);

}  // namespace twinbench::plausible
