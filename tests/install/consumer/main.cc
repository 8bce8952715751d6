#include <iostream>

#include "twin/benches/registry.h"
#include "twin/core/run_record.h"

int main(int, char** arguments) {
  const twinbench::Scenario scenario = twinbench::LoadScenario(arguments[1]);
  const auto record = twinbench::RunRecord::CreateInMemory({"consumer", "twin", scenario.seed, "", scenario.bench});
  twinbench::BenchOf(scenario).make_twin(scenario)->CarryOut(*record, {});
  std::cout << record->Readings().size() << " readings\n";
}
