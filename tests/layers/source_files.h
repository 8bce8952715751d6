#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

/// The project's own code as text, for tests of what compilers do not look at.
namespace twinbench {

inline const std::filesystem::path kProject = TWINBENCH_SOURCE_DIR;

/// Where code lies that is no test.
inline const std::vector<std::string> kCodeFolders = {"optics", "mechanics", "twin", "hw_bridge", "tools"};

/// @param extensions  Of these alone: ".h".
/// @return paths from the project's root, below `folders`.
inline std::vector<std::string> FilesBelow(const std::vector<std::string>& folders,
                                           const std::vector<std::string>& extensions = {".h", ".cc"}) {
  std::vector<std::string> files;
  for (const std::string& folder : folders)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kProject / folder))
      if (entry.is_regular_file() &&
          std::ranges::find(extensions, entry.path().extension().string()) != extensions.end())
        files.push_back(std::filesystem::relative(entry.path(), kProject).string());
  return files;
}

/// @return the lines of `file`, a path from the project's root. The first is line 1 to an editor.
inline std::vector<std::string> LinesOf(const std::string& file) {
  std::ifstream in(kProject / file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

inline std::string TextOf(const std::string& file) {
  std::ifstream in(kProject / file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace twinbench
