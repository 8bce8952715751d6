#include "tools/twinbench/passing_run.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/run_record.h"

namespace twinbench::tools {
namespace {

/// A folder that goes at the end of its life.
class PassingFolder {
 public:
  PassingFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "twinbench_XXXXXX").string();
    if (!mkdtemp(name.data())) throw BenchError("no temporary folder can be made");
    path_ = name;
  }
  ~PassingFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;
  std::string Run() const { return (path_ / "run").string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace

std::vector<Reading> ReadingsOfTwin(const Scenario& scenario) {
  const PassingFolder folder;
  const auto record =
      RunRecord::Create(folder.Run(), {TWINBENCH_VERSION, "twin", scenario.seed, "", scenario.bench});
  BenchOf(scenario).make_twin(scenario)->CarryOut(*record, {});
  return record->Readings();
}

}  // namespace twinbench::tools
