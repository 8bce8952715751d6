#pragma once

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "twin/uncertainty/joint.h"

namespace twinbench::report {

/// A result as a file for other programs.
struct ResultTable {
  std::string file;  // "compensation.csv"
  std::string text;
};

/// What the readings of any bench come to.
struct Evaluation {
  nlohmann::json results;     // results.json
  nlohmann::json separation;  // separation.json (formats.md); null if there is none
  std::string not_separated;  // why
  std::string summary;        // for a person
  std::vector<ResultTable> tables = {};
  /// Results that the readings leave uncertain together; empty: none. Asked for only where somebody wants their matrices, as large as the square of the
  /// results.
  std::function<std::vector<uncertainty::Joint>()> joints = {};

  bool Separated() const { return !separation.is_null(); }
  std::vector<uncertainty::Joint> Joints() const { return joints ? joints() : std::vector<uncertainty::Joint>(); }
};

/// One estimated number and what it should have been, in the unit of its name.
struct ScoredValue {
  std::string name;  // "target.ez_arcsec[3]"
  double value, u, truth;
  double dof = std::numeric_limits<double>::infinity();  // behind u
};

/// Compares a run of the twin with its truth.
struct ScoredRun {
  nlohmann::json json;
  std::string text, positions;           // for a person; `positions`: one row a position
  std::vector<ScoredValue> values = {};  // those that have a stated uncertainty, one by one
};

}  // namespace twinbench::report
