// Writes a record of so many readings and says after each that it is kept: power_cut_writer FOLDER READINGS [sparing]
// `sparing`: as a twin's run, and said once, behind the last.
#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "tests/power_cut/numbered.h"
#include "twin/benches/names.h"

int main(int argc, char** argv) {
  using namespace twinbench;
  if (argc < 3) return 2;
  const bool sparing = argc == 4 && std::string(argv[3]) == "sparing";
  const std::string folder = argv[1];
  const auto record = RunRecord::Create(folder, {"test", "writer", 1, "", kRotaryBench});
  record->WriteBeside("truth.json", "{}");
  if (sparing) record->SpareTheDisk();
  const int acknowledged = open((folder + "/acknowledged").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  for (int k = 0; k < std::atoi(argv[2]); ++k) {
    record->Called({Time{}, "adc", "acquire 3000", std::to_string(k)});
    record->Append(test::NumberedReading(k), test::NumberedBlock(k));
    if (!sparing && k % 25 == 0) record->WriteBeside("results.json", std::to_string(k));
    const std::string line = std::to_string(k) + "\n";
    if (!sparing && write(acknowledged, line.data(), line.size()) < 0) return 1;
  }
  record->Finish();
  return sparing && write(acknowledged, "all\n", 4) < 0;
}
