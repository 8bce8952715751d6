#include "tools/twinbench/overwriting.h"

#include <filesystem>
#include <fstream>

#include "twin/core/errors.h"
#include "twin/core/run_record.h"

namespace twinbench::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFirstLines_B = 512;

bool BeginsLike(const std::string& path, std::string_view own) {
  std::string begin(kFirstLines_B, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin.find(own) != std::string::npos;
}

void RequireOldRunOfTwin(const RunFolder& folder) {
  if (RunRecord::HasWriter(folder.path))
    throw InputError(folder.record(), "another program is writing it", "a folder without a record");
  const std::string source = RunRecord::Open(folder.path)->provenance().source;
  if (source != "twin")
    throw InputError(folder.record(), "this record was not made by the twin (" + source + ") and cannot be made again; --force is not for it",
                     "a folder without one");
}

void TakeAway(const RunFolder& folder) {
  for (const std::string& file : {folder.record(), folder.record() + "-wal", folder.record() + "-shm", folder.scenario(), folder.truth(),
                                  folder.results(), folder.path + "/report.html", folder.score()})
    fs::remove(file);
  fs::remove_all(folder.images());
}

}  // namespace

void AddForce(CLI::App& command, bool& force) {
  command.add_flag("--force", force, "overwrite what is there already; inputs and measured records never");
}

void RequireFree(const std::string& output, const std::vector<std::string>& inputs, bool force, std::string_view own) {
  RequireOutput(output, inputs);
  std::error_code unknown;
  if (force || output.empty() || output == "-" || !fs::is_regular_file(output, unknown)) return;
  if (fs::file_size(output, unknown) == 0 || (!own.empty() && BeginsLike(output, own))) return;
  throw InputError(output, "the file is there already", "a name that is not taken, or --force to overwrite it");
}

void MakeWayForRun(const RunFolder& folder, const std::string& scenario, bool force) {
  std::error_code unknown;
  const bool has_record = fs::exists(folder.record());
  if (has_record && !force)
    throw InputError(folder.record(), "there is a record already", "a folder without one, or --force to make the twin's run again");
  if (!force) return;
  if (fs::equivalent(folder.scenario(), scenario, unknown))
    throw InputError(folder.scenario(), "the command reads this file and would overwrite it", "another folder");
  if (has_record) RequireOldRunOfTwin(folder);
  TakeAway(folder);
}

}  // namespace twinbench::tools
