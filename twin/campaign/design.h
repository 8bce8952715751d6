#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "twin/campaign/study.h"

namespace twinbench::campaign {

/// Which values every trial has. A trial depends on study and number alone, however the trials are shared out.
///
/// The last grid changes fastest; at each of its points there are Study::trials trials in sequence. Distributions
/// are sampled by their quantiles at uniform numbers; in a Latin hypercube (McKay, Beckman and Conover,
/// Technometrics 21 (1979) 239-245) the trials of a point have one such number in each of as many equal strata, for
/// every key in an order of its own.
class Design {
 public:
  /// @throws InputError if there are more trials than can be counted.
  explicit Design(const Study& study);

  std::int64_t Trials() const { return points_ * study_.trials; }
  /// Of the trial's scenario: the first words of the trial's own stream.
  std::uint64_t SeedOf(std::int64_t trial) const;
  /// One a variation, in their order; text as after "key=".
  std::vector<std::string> ValuesOf(std::int64_t trial) const;
  /// "key=value" of every variation and the seed: what the twin has.
  std::vector<std::string> OverridesOf(std::int64_t trial) const;
  /// The same without what is hidden: what evaluation and diagnosis believe.
  std::vector<std::string> BelievedOf(std::int64_t trial) const;

 private:
  std::vector<std::string> Overrides(std::int64_t trial, bool with_hidden) const;
  double UniformOf(const std::string& key, std::int64_t trial) const;
  std::int64_t StratumOf(const std::string& key, std::int64_t trial) const;

  Study study_;
  std::int64_t points_ = 1;  // of the grids
};

}  // namespace twinbench::campaign
