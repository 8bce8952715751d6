#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace twinbench::certificate {

/// A part of results.json that a certificate may state, and what it says of which thing.
struct CertifiedPart {
  std::string path;     // "separation.target"; "[]" after a list
  std::string subject;  // as `not_separable` names it; empty: it is none of several
  std::string title;
  std::string norm;     // that defines the values; may be empty
};

/// How a bench measures, and what of its results is a result of a calibration.
struct CertifiedBench {
  std::string bench, method;
  std::vector<CertifiedPart> parts;
};

/// Where a list of values was taken: "position" in the unit \\degree.
struct Abscissa {
  std::string name, dsi_unit;
  std::vector<double> values;
};

/// A result that can be stated, in the unit of results.json; an expanded uncertainty each, for 95 %.
struct CertifiedQuantity {
  std::string title;  // "table under test, ez"
  std::string note;   // what the values do not hold, and why; may be empty
  std::string norm;
  std::string unit, dsi_unit;
  std::vector<double> values, expanded;
  double coverage_factor = 0.0;
  bool is_normal = true;               // else Student's t
  std::vector<Abscissa> where = {};    // as long as `values`; empty: one value
};

/// A result that cannot.
struct LeftOut {
  std::string what, why;
};

struct Certified {
  std::vector<CertifiedQuantity> quantities;
  std::vector<LeftOut> left_out;
};

/// Takes out of results.json what a certificate may state. Nothing is computed but k u.
///
/// Not stated: values without uncertainty or with one of 0 or less; points whose status is not "ok"; phases that are known to half a turn or worse; what
/// `not_separable` says of the thing as a whole; curves and lines in which a sum of two things is counted as one's; units that the D-SI
/// does not know. A curve from which an order is missing says so in its note.
/// The coverage factor is that of the uncertainty budget for 95 %; where there is none, that of the normal distribution.
/// @param results  results.json
Certified TakeCertified(const nlohmann::json& results, const CertifiedBench& bench);

}  // namespace twinbench::certificate
