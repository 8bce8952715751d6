#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <vector>

namespace twinbench {

/// One TOML text: the scenario's file, or one --set.
struct TomlSource {
  std::string name;  // "file.toml" or "--set key=value"
  bool is_override = false;
  std::vector<std::string> lines;
  toml::table root;
};

/// A value in a source. Does not own them.
class TomlValue {
 public:
  TomlValue(const toml::node& node, const TomlSource& source) : node_(&node), source_(&source) {}

  const toml::node& node() const { return *node_; }
  const TomlSource& source() const { return *source_; }
  TomlValue With(const toml::node& node) const { return {node, *source_}; }

  std::string Where() const;  // "file.toml:12", "--set key=value"
  std::string Found() const;  // for messages: the value as it was written, or what it is ("a table")
  /// The number as it was written, without `_`.
  /// @throws InputError, asking for `expected`, if it is none or is not finite.
  std::string NumberText(const std::string& key, const std::string& expected) const;

 private:
  std::string Literal() const;

  const toml::node* node_;
  const TomlSource* source_;
};

/// The scenario's text and the overrides over it.
class ScenarioText {
 public:
  /// @throws InputError with file:line for a syntax error.
  ScenarioText(const std::string& text, const std::string& name, const std::vector<std::string>& overrides);

  const std::vector<TomlSource>& sources() const { return sources_; }
  const std::string& name() const { return sources_.front().name; }

  /// @return what the last source that has `path` ("laser.wavelength_nm") gives there, or nothing.
  std::optional<TomlValue> Find(const std::string& path) const;
  /// Where `path` is set, or else `fallback`.
  std::string Where(const std::string& path, const std::string& fallback) const;

 private:
  std::vector<TomlSource> sources_;  // the file first
};

}  // namespace twinbench
