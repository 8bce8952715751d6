#pragma once

#include <functional>

#include "twin/diagnose/diagnose.h"

/// Cases with something hidden in them, and what a right answer to each is.
namespace twinbench::hidden {

/// One cause as it was hidden. Parameters that are not known stay out.
struct Part {
  std::string effect, where;                 // where: empty if the truth does not say
  std::map<std::string, double> parameters;  // SI, by the catalogue's names
};

/// What is wrong with the readings of a case. Neither causes nor an unlisted one: nothing is.
struct Hidden {
  std::vector<Part> causes = {};        // of the catalogue; two of them: a pair
  std::vector<std::string> alike = {};  // effects that these readings cannot tell from the cause, itself included
  std::string unlisted = {};            // a cause that the catalogue lacks; empty: none
  std::vector<std::string> locks = {};  // of the unlisted one: its signature must have one of these words
  std::vector<std::string> channels = {};  // ... and the channels that it must name; empty: not asked
  std::string noise = {};                  // what is special about the noise: "t5", "AR(1) 0.3"
  bool invisible = false;                  // the free unknowns take it up entirely: finding nothing is right
  double rho = kNaN;                       // intended length of the signature after projection, in units of noise

  bool IsClean() const { return causes.empty() && unlisted.empty(); }
};

struct Case {
  Hidden hidden = {};
  Scenario scenario = {};  // what is believed of the bench
  std::vector<Reading> readings = {};
  diagnose::DiagnoseOptions options = {};
};

/// A case before it is made: thousands of them fit into memory.
struct Plan {
  std::string set, name;
  std::function<Case()> make;
};

template <class T>
std::vector<T> Every(std::size_t step, const std::vector<T>& all) {
  std::vector<T> some;
  for (std::size_t k = 0; k < all.size(); k += step) some.push_back(all[k]);
  return some;
}

/// "psd_gain psd_a_x", "backlash + tone all", "none", "unlisted etalon".
std::string InWords(const Hidden& hidden);

}  // namespace twinbench::hidden
