#pragma once

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

/// @throws InputError for a bench whose results nobody has said this of.
const CertifiedBench& CertifiedPartsOf(const std::string& bench, const std::string& where);

}  // namespace twinbench::certificate
