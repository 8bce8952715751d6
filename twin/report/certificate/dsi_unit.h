#pragma once

#include <optional>
#include <string>

namespace twinbench::certificate {

/// A unit of results.json ("um/m", "arcsec") as the D-SI writes it ("\micro\metre\metre\tothe{-1}"; the SI Brochure's units in the notation of
/// the LaTeX package siunitx); nothing if it is none that the D-SI knows, as "px".
std::optional<std::string> DsiUnit(const std::string& unit);

}  // namespace twinbench::certificate
