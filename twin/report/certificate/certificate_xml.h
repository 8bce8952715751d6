#pragma once

#include <string>
#include <utility>
#include <vector>

#include "twin/report/certificate/certified.h"
#include "twin/report/certificate/laboratory.h"

namespace twinbench::certificate {

/// The temperature of the calibration.
struct Temperature {
  double value_degC = 0.0;
  double expanded_degC = 0.0;  // for about 95 %; 0: not known
  std::string remark;          // where it comes from
};

/// Everything that goes into a certificate.
struct CertificateContent {
  Laboratory laboratory;
  Certified certified;  // at least one quantity
  std::string method;
  std::string run, scenario_title, readings_from, recorded_by, program_version;
  bool simulated = false;
  Temperature temperature;
  std::string diagnosis;  // what `diagnose` has found in the readings; may be empty
  std::vector<std::pair<std::string, std::string>> digests;  // file, SHA-256
};

/// The certificate as an XML document, UTF-8: DCC 3.3.0 (https://ptb.de/dcc/v3.3.0/dcc.xsd) with quantities of the D-SI 2.2
/// (https://ptb.de/si/v2.2.1/SI_Format.xsd).
///
/// Numbers stand in full; texts for people hold them rounded to two digits of the uncertainty (GUM 7.2.6). A simulation says so in the
/// title of the results, in the name of each, in a statement and in the comment, and claims no traceability.
std::string CertificateXml(const CertificateContent& content);

}  // namespace twinbench::certificate
