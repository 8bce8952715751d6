#include "twin/campaign/design.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/stream.h"

namespace twinbench::campaign {
namespace {

constexpr std::int64_t kMostTrials = 1'000'000'000;

/// Uniform numbers come with 53 bits and may be 0, at which a normal variable has no value.
double Inside01(double uniform) {
  return std::clamp(uniform, 0x1p-54, 1.0 - 0x1p-53);
}

/// Fisher-Yates.
std::vector<std::int64_t> Shuffled(std::int64_t count, Stream& stream) {
  std::vector<std::int64_t> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), std::int64_t{0});
  for (std::size_t left = order.size(); left > 1; --left)
    std::swap(order[left - 1], order[static_cast<std::size_t>(stream.Uniform() * static_cast<double>(left))]);
  return order;
}

}  // namespace

Design::Design(const Study& study) : study_(study) {
  for (const Variation& variation : study.vary) {
    const auto* grid = std::get_if<Grid>(&variation.how);
    if (!grid) continue;
    points_ *= static_cast<std::int64_t>(grid->values.size());
    if (Trials() > kMostTrials)
      throw InputError(variation.location, fmt::format("the grids come to more than {} trials", kMostTrials),
                       "fewer values");
  }
}

std::uint64_t Design::SeedOf(std::int64_t trial) const {
  Stream stream(study_.seed, fmt::format("campaign.trial.{}", trial));
  const std::uint64_t high = stream.Word();
  return (high << 32) | stream.Word();
}

double Design::UniformOf(const std::string& key, std::int64_t trial) const {
  Stream stream(study_.seed, "campaign.vary." + key);
  stream.Seek(static_cast<std::uint64_t>(trial));
  const double uniform = stream.Uniform();
  if (study_.sampling == Sampling::kRandom) return Inside01(uniform);
  return Inside01((static_cast<double>(StratumOf(key, trial)) + uniform) / study_.trials);
}

std::int64_t Design::StratumOf(const std::string& key, std::int64_t trial) const {
  Stream stream(study_.seed, fmt::format("campaign.strata.{}.{}", trial / study_.trials, key));
  return Shuffled(study_.trials, stream)[static_cast<std::size_t>(trial % study_.trials)];
}

std::vector<std::string> Design::ValuesOf(std::int64_t trial) const {
  std::vector<std::string> values(study_.vary.size());
  std::int64_t point = trial / study_.trials;
  for (std::size_t k = study_.vary.size(); k-- > 0;) {
    const Variation& variation = study_.vary[k];
    if (const auto* grid = std::get_if<Grid>(&variation.how)) {
      const auto count = static_cast<std::int64_t>(grid->values.size());
      values[k] = grid->values[static_cast<std::size_t>(point % count)];
      point /= count;
    } else {
      values[k] =
          PrintInUnit(Quantile(std::get<Distribution>(variation.how), UniformOf(variation.key, trial)), 1.0);
    }
  }
  return values;
}

std::vector<std::string> Design::Overrides(std::int64_t trial, bool with_hidden) const {
  const std::vector<std::string> values = ValuesOf(trial);
  std::vector<std::string> overrides;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (with_hidden || !study_.vary[k].hidden) overrides.push_back(study_.vary[k].key + "=" + values[k]);
  }
  overrides.push_back(fmt::format("seed=\"{}\"", SeedOf(trial)));
  return overrides;
}

std::vector<std::string> Design::OverridesOf(std::int64_t trial) const {
  return Overrides(trial, true);
}

std::vector<std::string> Design::BelievedOf(std::int64_t trial) const {
  return Overrides(trial, false);
}

}  // namespace twinbench::campaign
