#pragma once

#include <vector>

namespace twinbench::imports {

/// A file of the folder maps/, as it was when the program was built.
struct ReadyText {
  const char* name;
  const char* text;
};

const std::vector<ReadyText>& ReadyTexts();

}  // namespace twinbench::imports
