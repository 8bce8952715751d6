#include "tests/power_cut/write_log.h"

#include <fstream>

#include "twin/core/errors.h"

namespace twinbench::test {
namespace {

constexpr std::size_t kSector_B = 512;

void Write(const FileChange& change, std::string& content) {
  if (change.what == 't') return content.resize(change.at);
  content.resize(std::max<std::size_t>(content.size(), change.at + change.data.size()));
  std::copy(change.data.begin(), change.data.end(), content.begin() + static_cast<long>(change.at));
}

/// A write of which some sectors did not arrive.
void WriteTorn(const FileChange& change, std::string& content, std::mt19937_64& random) {
  if (change.what == 't') return Write(change, content);
  std::bernoulli_distribution arrives(0.8);
  for (std::size_t begin = 0; begin < change.data.size(); begin += kSector_B) {
    if (!arrives(random)) continue;
    FileChange sector = change;
    sector.at = change.at + begin;
    sector.data = change.data.substr(begin, kSector_B);
    Write(sector, content);
  }
}

}  // namespace

std::vector<FileChange> ReadWriteLog(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::vector<FileChange> changes;
  const auto get = [&](void* into, std::size_t size) {
    in.read(static_cast<char*>(into), static_cast<std::streamsize>(size));
  };
  for (char what; in.get(what);) {
    std::uint32_t length = 0;
    std::uint64_t at = 0, size = 0;
    get(&length, sizeof length);
    std::string name(length, ' ');
    get(name.data(), length);
    get(&at, sizeof at);
    get(&size, sizeof size);
    std::string data(size, ' ');
    get(data.data(), size);
    if (!in) throw BenchError(path + ": ends in the middle of a change");
    changes.push_back({what, name, at, data});
  }
  return changes;
}

void ForgetfulDisk::ChangeNames(const FileChange& change, int file, Names& names) {
  if (change.what == 'c') names[change.path] = file;
  if (change.what == 'u') names.erase(change.path);
  if (change.what != 'r') return;
  names.erase(change.path);
  names[change.data] = file;
}

void ForgetfulDisk::Apply(const FileChange& change) {
  if (change.what == 'c' || change.what == 'r' || change.what == 'u') {
    if (change.what == 'c') files_.emplace_back();
    const int file = change.what == 'c' ? static_cast<int>(files_.size()) - 1 : names_.at(change.path);
    ChangeNames(change, file, names_);
    pending_names_.emplace_back(change, file);
    return;
  }
  const auto named = names_.find(change.path);
  if (named == names_.end()) {  // only folders have no file here; a sync of one keeps the names in it
    synced_names_ = names_;
    pending_names_.clear();
    return;
  }
  File& file = files_[static_cast<std::size_t>(named->second)];
  if (change.what != 's') return file.pending.push_back(change);
  for (const FileChange& pending : file.pending) Write(pending, file.synced);
  file.pending.clear();
}

std::string ForgetfulDisk::ContentAfter(const File& file, Left left, std::mt19937_64& random) {
  std::string content = file.synced;
  const std::size_t kept = std::uniform_int_distribution<std::size_t>(0, file.pending.size())(random);
  std::bernoulli_distribution arrives(0.5);
  for (std::size_t k = 0; k < file.pending.size(); ++k) {
    if (left == Left::kPrefix && k < kept) Write(file.pending[k], content);
    if (left == Left::kTornSubset && arrives(random)) WriteTorn(file.pending[k], content, random);
  }
  return content;
}

std::map<std::string, std::string> ForgetfulDisk::AfterPowerCut(Left left, std::mt19937_64& random) const {
  Names names = synced_names_;
  const std::size_t kept = std::uniform_int_distribution<std::size_t>(0, pending_names_.size())(random);
  for (std::size_t k = 0; k < kept; ++k) ChangeNames(pending_names_[k].first, pending_names_[k].second, names);
  std::map<std::string, std::string> files;
  for (const auto& [path, file] : names)
    files[path] = ContentAfter(files_[static_cast<std::size_t>(file)], left, random);
  return files;
}

}  // namespace twinbench::test
