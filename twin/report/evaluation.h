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

/// What a fit leaves of readings, rms, over the standard uncertainty that is stated of them; 1 if both are right.
struct Misfit {
  std::string of;  // "ccd_px"
  double per_u;    // NaN: nothing is stated, or nothing is left over
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
  std::vector<Misfit> misfits = {};  // of the fits behind it, where an uncertainty is stated that is not theirs
  /// Bench::score of the same readings without another analysis; empty: it has to be asked.
  std::function<ScoredRun(const nlohmann::json& truth)> score = {};

  bool Separated() const { return !separation.is_null(); }
  /// Whether a fit does not describe the readings (report/sound.h).
  bool IsRefuted() const { return results.contains("not_described"); }
  std::vector<uncertainty::Joint> Joints() const { return joints ? joints() : std::vector<uncertainty::Joint>(); }
};

}  // namespace twinbench::report
