#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include "twin/core/compensation_table.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_file.h"
#include "twin/core/scenario_reader.h"
#include "twin/core/table_errors.h"

namespace twinbench {
namespace {

std::string AbsolutePath(const std::string& folder, const std::string& file) {
  return std::filesystem::absolute(std::filesystem::path(folder) / file).lexically_normal().string();
}

/// @return the absolute path of the file that `key` names.
/// @param where  The key stands there.
std::string NamedFile(const std::string& where, const std::string& key, const std::string& folder,
                      const std::string& file) {
  const std::string path = AbsolutePath(folder, file);
  if (std::filesystem::is_regular_file(path) && std::ifstream(path)) return path;
  throw InputError(where, fmt::format("{}: the file {} cannot be read", key, path),
                   OrNearestFile("a readable file, named from the scenario's folder", path));
}

/// Moves the content of the file that `content`_file names to `content`. Where both are given the later source
/// counts.
/// @param content  "target.errors"
template <class Content>
void LoadContent(const ScenarioText& text, const std::string& content, const std::string& folder, std::string& name,
                 Content (*read)(const std::string&), std::optional<Content>& place) {
  if (name.empty()) return;
  const std::string key = content + "_file";
  const auto block = text.Find(content);
  const auto file = text.Find(key);
  if (block && &block->source() == &file->source())
    throw InputError(file->Where(), fmt::format("{} is given beside a table {}", key, content), "one of them");
  const bool file_is_later = !block || &file->source() > &block->source();
  if (file_is_later) place = read(NamedFile(file->Where(), key, folder, name));
  name.clear();
}

/// Where the text of a key is.
std::string& FileNameAt(const std::vector<ScenarioKey>& keys, const std::string& path) {
  const auto key = std::ranges::find(keys, path, &ScenarioKey::Path);
  Require(key != keys.end(), "content of a table has no file that could name it");
  return *std::get<std::string*>(key->field);
}

}  // namespace

void LoadFiles(const ScenarioText& text, const std::string& folder, const std::vector<ScenarioKey>& keys) {
  for (const ScenarioKey& key : keys) {
    if (key.names_a_file) {
      std::string& file = *std::get<std::string*>(key.field);
      if (!file.empty()) file = NamedFile(text.Where(key.Path(), text.name() + ":1"), key.Path(), folder, file);
    }
    if (auto* const* errors = std::get_if<std::optional<TableErrors>*>(&key.field))
      LoadContent(text, key.Path(), folder, FileNameAt(keys, key.Path() + "_file"), ReadTableErrors, **errors);
    if (auto* const* compensation = std::get_if<std::optional<CompensationTable>*>(&key.field))
      LoadContent(text, key.Path(), folder, FileNameAt(keys, key.Path() + "_file"), ReadCompensationTable,
                  **compensation);
  }
}

void LoadMeshes(const std::string& folder, std::vector<FixtureSettings>& fixtures) {
  for (FixtureSettings& f : fixtures) {
    if (!f.mesh_file.empty()) f.mesh_file = NamedFile(f.location, "fixture.mesh_file", folder, f.mesh_file);
  }
}

}  // namespace twinbench
