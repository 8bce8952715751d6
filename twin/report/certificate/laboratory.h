#pragma once

#include <limits>
#include <string>

namespace twinbench::certificate {

/// A place and who is there.
struct Contact {
  std::string name, street, street_no, post_code, city, country, email;
};

/// What only the laboratory knows about a calibration.
struct Laboratory {
  // [certificate]
  std::string identifier, country, language = "en", begin, end, issued, location = "laboratory";
  bool simulated = false;  // also where the record does not show it
  Contact laboratory;
  std::string accreditation;
  Contact customer;
  std::string person, role;
  // [item]
  std::string item, manufacturer, model, serial, description;
  // [conditions]; NaN: those of the readings
  double temperature_degC = std::numeric_limits<double>::quiet_NaN();
  double expanded_temperature_degC = std::numeric_limits<double>::quiet_NaN();  // for about 95 %
  std::string traceability;
};

/// Reads what `twinbench certificate --template` writes.
/// @param name  Of the file, for messages.
/// @throws InputError with file:line for a syntax error, an unknown key, a date that is none or a country that is none, and with
///         all keys that are missing or empty.
Laboratory ReadLaboratory(const std::string& text, const std::string& name);

/// The file with every key and what it means; what has to be filled in is empty.
std::string LaboratoryTemplate();

}  // namespace twinbench::certificate
