#pragma once

#include <string>
#include <variant>
#include <vector>

/// How one key of a scenario differs from trial to trial. Numbers are in the unit of the key.
namespace twinbench::campaign {

/// Every value in turn, combined with those of every other grid. A value is text as after "key=".
struct Grid {
  std::vector<std::string> values;
};

struct Normal {
  double mean, sd;
};
struct Uniform {
  double lower, upper;
};
struct Triangular {
  double lower, mode, upper;
};
/// The logarithm is uniform: every decade is as likely as any other.
struct LogUniform {
  double lower, upper;  // positive
};
using Distribution = std::variant<Normal, Uniform, Triangular, LogUniform>;

struct Variation {
  std::string key;  // as after --set
  std::variant<Grid, Distribution> how;
  bool hidden = false;   // from evaluation and diagnosis: they believe the base scenario's value
  std::string location;  // "study.toml:7", for messages
};

/// The value that is not exceeded with this probability, 0 < p < 1.
double Quantile(const Distribution& distribution, double p);

}  // namespace twinbench::campaign
