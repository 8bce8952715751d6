#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>

#include "hw_bridge/bench_file.h"
#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

constexpr int kWatchdog_s = 10;
constexpr const char* kScpiIdentity = "twinbench,rotary-bench,";
constexpr const char* kEspIdentity = "ESP301 twinbench ";

std::string TableText(const std::string& table, int axis, const ServedAddresses& a, const std::string& language) {
  const std::string kind = language == "scpi" ? "scpi" : "esp";
  const std::string address = language == "scpi"  ? fmt::format("tcp:{}:{}", a.host, a.scpi_port)
                              : language == "esp" ? fmt::format("tcp:{}:{}", a.host, a.esp_port)
                                                  : "serial:" + a.pty;
  return fmt::format("\n[{}]\nkind = \"{}\"\naddress = \"{}\"\nidentity = \"{}\"\naxis = {}\n", table, kind,
                     address, kind == "scpi" ? kScpiIdentity : kEspIdentity, axis);
}

std::string InstrumentText(const std::string& table, const ServedAddresses& a) {
  return fmt::format("\n[{}]\nkind = \"scpi\"\naddress = \"tcp:{}:{}\"\nidentity = \"{}\"\n", table, a.host,
                     a.scpi_port, kScpiIdentity);
}

}  // namespace

std::string WithGuards(const std::string& bench_file, const std::string& token) {
  std::istringstream lines(bench_file);
  std::string text, watchdog;
  for (std::string line; std::getline(lines, line);) {
    text += line + "\n";
    if (line.starts_with("kind = ")) watchdog = line == "kind = \"esp\"" ? "XW" : "SYST:WATC ";
    if (!line.starts_with("identity = ")) continue;
    text += fmt::format("watchdog = \"{}{}\"\n", watchdog, kWatchdog_s);
    if (!token.empty()) text += fmt::format("token = \"{}\"\n", token);
  }
  return text;
}

void RequireTokenText(const std::string& where, const std::string& token) {
  const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0; };
  if (!std::ranges::all_of(token, is_plain))
    throw InputError(where, "a token has something else in it than letters and digits", "what serve printed");
}

std::string WriteServedBenchFile(const ServedAddresses& addresses, const std::string& tables) {
  Require(tables == "scpi" || tables == "esp" || tables == "pty", "tables are driven by scpi, esp or pty");
  Require(tables != "pty" || !addresses.pty.empty(), "there is no pseudo-terminal");
  std::string text = fmt::format(
      "{}kind = \"hardware\"\nname = \"served twin\"\n\n"
      "[adc]\nkind = \"iio\"\nuri = \"ip:{}:{}\"\ndevice = \"psd-adc16\"\n"
      "channels = [\"voltage0\", \"voltage1\", \"voltage2\", \"voltage3\"]\nlight = \"light\"\n",
      kServedBenchFile, addresses.host, addresses.iiod_port);
  text += TableText("target", 1, addresses, tables) + TableText("reference", 2, addresses, tables);
  for (const char* table : {"autocollimator", "thermometer", "goniometer", "fixture", "clock"})
    text += InstrumentText(table, addresses);
  return text;
}

}  // namespace twinbench::hw
