#pragma once

#include <string>
#include <vector>

#include "twin/plan/outlook.h"

namespace twinbench::plan {

/// What the own run loses and the other one does not.
std::vector<std::string> MendedBy(const Outlook& own, const Outlook& other);

/// The same in words; what comes back in parts only names those that stay: "both tables but for order 2".
std::vector<std::string> MendedInWords(const Outlook& own, const Outlook& other);

/// Of that, what the other one loses no part of but those that a good set of shifts loses too: "target dy" is not mended
/// where "target dy orders 2, 4" stays.
std::vector<std::string> WhollyMendedBy(const Outlook& own, const Outlook& other, const Outlook& good);

}  // namespace twinbench::plan
