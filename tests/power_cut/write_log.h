#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

/// What a program did to its files, and what a disk may hold of it after the power failed.
namespace twinbench::test {

struct FileChange {
  char what;         // 'c'reate, 'w'rite, 't'runcate, 's'ync, 'r'ename, 'u'nlink
  std::string path;  // absolute
  std::uint64_t at;  // of a write; new size of a truncation
  std::string data;  // of a write; new path of a rename
};

/// @throws BenchError if the file ends in the middle of a change.
std::vector<FileChange> ReadWriteLog(const std::string& path);

/// A disk that keeps in order only what it was told to keep: file contents by fsync of the file, names by fsync of
/// the folder.
class ForgetfulDisk {
 public:
  void Apply(const FileChange& change);

  /// Which of the writes that were not yet synced a power cut leaves.
  enum class Left { kPrefix, kTornSubset };
  /// @return the files that are there after it, by path.
  std::map<std::string, std::string> AfterPowerCut(Left left, std::mt19937_64& random) const;

 private:
  struct File {
    std::string synced;
    std::vector<FileChange> pending;
  };
  using Names = std::map<std::string, int>;  // path -> file
  static void ChangeNames(const FileChange& change, int file, Names& names);
  static std::string ContentAfter(const File& file, Left left, std::mt19937_64& random);

  std::vector<File> files_;
  Names names_, synced_names_;
  std::vector<std::pair<FileChange, int>> pending_names_;
};

}  // namespace twinbench::test
