#include "twin/core/scenario_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <sstream>

#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/toml_bounds.h"

namespace twinbench {
namespace {

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string WhereInFile(const std::string& name, const toml::source_region& region) {
  return fmt::format("{}:{}", name, std::max<toml::source_index>(region.begin.line, 1));
}

TomlSource ParseToml(const std::string& text, const std::string& name) {
  RequireModestKeys(text, name);
  try {
    return {name, false, Lines(text), toml::parse(text, std::string(name))};
  } catch (const toml::parse_error& error) {
    throw InputError(WhereInFile(name, error.source()), std::string(error.description()), "TOML");
  }
}

bool IsWord(const std::string& text) {
  const auto allowed = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("_-./", c); };
  return !text.empty() && std::all_of(text.begin(), text.end(), allowed);
}

std::optional<toml::table> TryToml(const std::string& text) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error&) {
    return std::nullopt;
  }
}

/// key=value; a value that is a word and no TOML gets its quotes, which a shell takes away too easily.
TomlSource ParseOverride(const std::string& text) {
  const std::string name = "--set " + text;
  RequireModestKeys(text, "--set");
  const auto equals = text.find('=');
  if (equals == std::string::npos)
    throw InputError(name, "there is no \"=\"", "key=value, as in laser.wavelength_nm=640");
  const std::string value = text.substr(equals + 1);
  if (auto root = TryToml(text)) return {name, true, Lines(text), std::move(*root)};
  const std::string quoted = text.substr(0, equals + 1) + '"' + value + '"';
  auto root = IsWord(value) ? TryToml(quoted) : std::nullopt;
  if (root) return {name, true, Lines(quoted), std::move(*root)};
  throw InputError(name, "this is not TOML", "key=value, as in laser.wavelength_nm=640 or title=\"two words\"");
}

const toml::node* FindIn(const toml::table& root, const std::string& path) {
  const toml::table* table = &root;
  std::istringstream in(path);
  const toml::node* node = nullptr;
  for (std::string key; std::getline(in, key, '.');) {
    node = table ? table->get(key) : nullptr;
    table = node ? node->as_table() : nullptr;
    if (!node) return nullptr;
  }
  return node;
}

/// The index of the byte where the n-th letter (from 1) of a UTF-8 line begins.
std::size_t ByteOfColumn(const std::string& line, std::size_t column) {
  std::size_t letters = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool begins_letter = (static_cast<unsigned char>(line[i]) & 0xC0) != 0x80;
    if (begins_letter && ++letters == column) return i;
  }
  return line.size();
}

}  // namespace

std::string TomlValue::Where() const {
  return source_->is_override ? source_->name : WhereInFile(source_->name, node_->source());
}

std::string TomlValue::Literal() const {
  const toml::source_position begin = node_->source().begin;
  if (begin.line < 1 || begin.line > source_->lines.size()) return "";
  const std::string& line = source_->lines[begin.line - 1];
  const std::size_t from = ByteOfColumn(line, begin.column);
  return line.substr(from, std::min(line.find_first_of(" \t\r,]}#", from), line.size()) - from);
}

std::string TomlValue::Found() const {
  if (node_->is_table()) return "a table";
  if (node_->is_array()) return "a list";
  if (const auto* text = node_->as_string()) return '"' + text->get() + '"';
  return Literal();
}

std::string TomlValue::NumberText(const std::string& key, const std::string& expected) const {
  const auto number = node_->is_number() ? node_->value<double>() : std::nullopt;
  if (!number || !std::isfinite(*number))
    throw InputError(Where(), fmt::format("{} is {}", key, Found()), expected);
  std::string text = Literal();
  std::erase(text, '_');
  const auto read = ParseNumber(text);
  if (read && *read == *number) return text;
  return PrintInUnit(*number, 1.0);  // 0x10 and the like
}

ScenarioText::ScenarioText(const std::string& text, const std::string& name,
                           const std::vector<std::string>& overrides) {
  sources_.push_back(ParseToml(text, name));
  for (const std::string& override_text : overrides) sources_.push_back(ParseOverride(override_text));
}

std::optional<TomlValue> ScenarioText::Find(const std::string& path) const {
  for (auto source = sources_.rbegin(); source != sources_.rend(); ++source) {
    if (const toml::node* node = FindIn(source->root, path)) return TomlValue(*node, *source);
  }
  return std::nullopt;
}

std::string ScenarioText::Where(const std::string& path, const std::string& fallback) const {
  const auto value = Find(path);
  return value ? value->Where() : fallback;
}

}  // namespace twinbench
