#include "hw_bridge/control/scpi_table.h"

#include <fmt/format.h>

#include "hw_bridge/control/scpi.h"
#include "twin/core/number_text.h"
#include "twin/core/units.h"

namespace twinbench::hw {
namespace {

constexpr std::size_t kStateFields = 7;
constexpr const char* kStateForm = "<deg>,<deg>,<0 1>,<0 1>,<0 1>,<-1 0 1>,\"<fault>\"";

}  // namespace

std::optional<TableState> ParseScpiState(const std::string& answer) {
  const auto fields = SplitScpi(answer);
  if (!fields || fields->size() != kStateFields) return std::nullopt;
  const auto commanded_rad = ParseScpiNumber((*fields)[0], units::deg);
  const auto encoder_rad = ParseScpiNumber((*fields)[1], units::deg);
  if (!commanded_rad || !encoder_rad) return std::nullopt;
  std::array<int, 4> flags{};  // moving, in position, referenced, limit
  for (std::size_t k = 0; k < flags.size(); ++k) {
    const auto flag = ParseWholeNumber((*fields)[2 + k]);
    const bool is_limit = k == 3;
    if (!flag || *flag > 1 || *flag < (is_limit ? -1 : 0)) return std::nullopt;
    flags[k] = static_cast<int>(*flag);
  }
  return TableState{*commanded_rad, *encoder_rad, flags[0] == 1, flags[1] == 1,
                    flags[2] == 1,  flags[3],     (*fields)[6]};
}

ScpiTable::ScpiTable(DeviceLine line, int axis, const TableLimits& limits, CommandNumbers numbers)
    : ControlledTable(std::move(line), limits, numbers), rotation_(fmt::format("ROT{}:", axis)) {}

void ScpiTable::SendMove(const std::string& angle_deg) {
  TellScpi(line(), rotation_ + "ANGL " + angle_deg);
}

bool ScpiTable::AwaitSettled(Duration within) {
  const std::string query = rotation_ + "SETT? " + PrintInUnit(ToSeconds(within), 1.0);
  const std::string answer = line().Ask(query, within);
  if (answer != "0" && answer != "1") line().FailProtocol(query, answer, "0 or 1");
  return answer == "1";
}

TableState ScpiTable::ReadState() {
  const std::string query = rotation_ + "STAT?";
  const std::string answer = line().Ask(query);
  const auto state = ParseScpiState(answer);
  if (!state) line().FailProtocol(query, answer, kStateForm);
  return *state;
}

void ScpiTable::SendStop() {
  TellScpi(line(), StopWord());
}

void ScpiTable::SendHome() {
  TellScpi(line(), rotation_ + "HOME");
}

AllowedMotion ScpiTable::ReadAllowed() {
  return {line().AskNumber(rotation_ + "LIM:LOW?", units::deg), line().AskNumber(rotation_ + "LIM:UPP?", units::deg)};
}

}  // namespace twinbench::hw
