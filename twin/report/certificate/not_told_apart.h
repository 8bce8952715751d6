#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace twinbench::certificate {

/// One entry of `not_separable` in results.json: "device and reference, order 3", "target ex,ey order +1", "reference dx".
struct NotToldApart {
  std::vector<std::string> subjects;    // "device", "reference"; empty: whatever there is
  std::vector<std::string> quantities;  // "ex"; empty: every one
  std::optional<int> order;             // without: all of it
  std::string what, why;

  bool Concerns(const std::string& subject, const std::string& quantity) const;
  /// A sum is counted as one of several; one alone is left out of its own curve.
  bool IsSum() const { return subjects.size() != 1; }
};

/// All of them, in the order of the file, each once.
std::vector<NotToldApart> AllNotToldApart(const nlohmann::json& results);

}  // namespace twinbench::certificate
