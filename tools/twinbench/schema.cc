#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/json_answer.h"
#include "twin/core/bench_format.h"
#include "twin/core/scenario_schema.h"

/// The keys of scenarios as JSON schema, by which editors complete and check (taplo, Even Better TOML).
namespace twinbench::tools {
namespace {

nlohmann::json Number(const char* type, const ScenarioKey& key) {
  nlohmann::json schema = {{"type", type}};
  if (std::isfinite(key.bounds.lower))
    schema[key.bounds.above_lower ? "exclusiveMinimum" : "minimum"] = key.bounds.lower;
  if (std::isfinite(key.bounds.upper)) schema["maximum"] = key.bounds.upper;
  return schema;
}

nlohmann::json ListOf(const nlohmann::json& item) {
  return {{"type", "array"}, {"items", item}};
}

nlohmann::json Text(const ScenarioKey& key) {
  nlohmann::json schema = {{"type", "string"}};
  if (!key.choices.empty()) schema["enum"] = key.choices;
  return schema;
}

/// One overload a type of value.
struct ValueSchema {
  const ScenarioKey& key;

  nlohmann::json operator()(const double*) const { return Number("number", key); }
  nlohmann::json operator()(const int*) const { return Number("integer", key); }
  nlohmann::json operator()(const std::uint64_t*) const { return {{"type", {"integer", "string"}}}; }
  nlohmann::json operator()(const bool*) const { return {{"type", "boolean"}}; }
  nlohmann::json operator()(const std::string*) const { return Text(key); }
  nlohmann::json operator()(std::span<double> field) const {
    nlohmann::json schema = ListOf(Number("number", key));
    schema["minItems"] = schema["maxItems"] = field.size();
    return schema;
  }
  nlohmann::json operator()(const std::vector<double>*) const { return ListOf(Number("number", key)); }
  nlohmann::json operator()(const std::vector<int>*) const { return ListOf(Number("integer", key)); }
  nlohmann::json operator()(const std::vector<std::string>*) const { return ListOf(Text(key)); }
  nlohmann::json operator()(const std::vector<HarmonicSettings>*) const { return ListOf({{"type", "object"}}); }
  nlohmann::json operator()(const std::optional<TableErrors>*) const { return {{"type", "object"}}; }
  nlohmann::json operator()(const std::optional<CompensationTable>*) const { return {{"type", "object"}}; }
  nlohmann::json operator()(const RecordList& list) const {
    nlohmann::json properties = nlohmann::json::object();
    for (const ScenarioKey& inner : list.example_keys())
      properties[inner.Name()] = std::visit(ValueSchema{inner}, inner.field);
    return ListOf({{"type", "object"}, {"properties", properties}, {"additionalProperties", false}});
  }
};

/// The table in which a key stands, made on the way: "target.random" lies in "target".
nlohmann::json& TableIn(nlohmann::json& root, const std::string& path) {
  nlohmann::json* table = &root;
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    table = &(*table)["properties"][path.substr(begin, end - begin)];
    (*table)["type"] = "object";
    begin = end + 1;
  }
  return *table;
}

nlohmann::json SchemaOf(const BenchFormat& bench) {
  Scenario defaults;
  defaults.bench = bench.name;
  nlohmann::json schema = {{"type", "object"}, {"title", bench.title}};
  for (const ScenarioKey& key : KeysOf(defaults)) {
    nlohmann::json value = std::visit(ValueSchema{key}, key.field);
    value["description"] = key.meaning;
    TableIn(schema, key.table)["properties"][key.Name()] = std::move(value);
  }
  schema["properties"]["bench"] = {{"const", bench.name}};
  return schema;
}

nlohmann::json SchemaOfAll() {
  nlohmann::json benches = nlohmann::json::array();
  for (const BenchFormat* bench : BenchFormats()) benches.push_back(SchemaOf(*bench));
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "scenario of twinbench"}, {"oneOf", benches}};
}

}  // namespace

void AddSchema(CLI::App& app) {
  auto* command = app.add_subcommand("schema", "Print the JSON schema of scenarios, for editors");
  AnswerWith(*command, "the schema", [](JsonAnswer& answer) {
    answer.Write(SchemaOfAll());
    if (!answer.IsWanted()) JsonAnswer("-").Write(SchemaOfAll());
  });
}

}  // namespace twinbench::tools
