#include "hw_bridge/file_places.h"

#include <fmt/format.h>

#include <filesystem>

#include "twin/core/errors.h"

namespace twinbench::hw {

std::string WhereIn(const KeyPlaces& places, const std::string& file, const std::string& key) {
  if (const auto found = places.find(key); found != places.end()) return found->second;
  if (const auto table = places.find(key.substr(0, key.find('.'))); table != places.end()) return table->second;
  return file + ":1";
}

void RefuseDevices(const KeyPlaces& places, const std::string& kind, const std::set<std::string>& kept) {
  for (const auto& [path, where] : places) {
    if (!kept.contains(path))
      throw InputError(where, fmt::format("{} in a bench of kind \"{}\"", path, kind), "kind = \"hardware\"");
  }
}

void CheckRecord(const KeyPlaces& places, const std::string& file, const std::string& kind, const std::string& record) {
  if (kind == "replay" && record.empty())
    throw InputError(WhereIn(places, file, "kind"), "kind is \"replay\" without a record",
                     "record = \"folder of the run\"");
  if (kind != "replay" && !record.empty())
    throw InputError(WhereIn(places, file, "record"), "there is a record in a bench of another kind",
                     "kind = \"replay\"");
}

void MakeAbsolute(const std::string& folder, std::string& path) {
  if (!path.empty())
    path = std::filesystem::absolute(std::filesystem::path(folder) / path).lexically_normal().string();
}

}  // namespace twinbench::hw
