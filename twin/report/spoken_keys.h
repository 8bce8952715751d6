#pragma once

#include <string>

namespace twinbench::report {

/// A key of results, of a scoring table or of an uncertainty's source as people read it, the key in brackets behind: "equation 5 of the
/// paper (equation_5.ez_arcsec)". A key that needs no words stays alone.
std::string WithWords(const std::string& key);

}  // namespace twinbench::report
