#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "tools/twinbench/answers.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/overwriting.h"
#include "twin/benches/certified_parts.h"
#include "twin/core/digest.h"
#include "twin/core/errors.h"
#include "twin/core/input_text.h"
#include "twin/core/run_record.h"
#include "twin/report/certificate/certificate_xml.h"
#include "twin/report/page/diagnosis_page.h"

namespace twinbench::tools {
namespace {

/// A document in a file that goes with the object.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text) : name_((std::filesystem::temp_directory_path() / "twinbench-XXXXXX").string()) {
    const int file = mkstemp(name_.data());
    if (file < 0) throw BenchError(fmt::format("{}: {}", name_, std::strerror(errno)));
    const bool is_whole = write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    close(file);
    if (!is_whole) throw BenchError(name_ + " could not be written");
  }
  ~TemporaryFile() { unlink(name_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  std::string& name() { return name_; }

 private:
  std::string name_;
};

/// @return the exit code of the program.
int RunXmllint(const std::string& folder, std::string document) {
  std::string schema = folder + "/dcc.xsd", path = folder;
  std::array<std::string, 5> words = {"xmllint", "--nonet", "--noout", "--path", "--schema"};
  const std::array<char*, 9> arguments = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), path.data(),
                                          words[4].data(), schema.data(),   document.data(), nullptr};
  pid_t id = 0;
  if (const int error = posix_spawnp(&id, "xmllint", nullptr, nullptr, arguments.data(), environ); error != 0)
    throw BenchError(fmt::format("xmllint cannot be run ({}); Debian has it in libxml2-utils", std::strerror(error)));
  int status = 0;
  while (waitpid(id, &status, 0) < 0 && errno == EINTR) continue;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Validates a document with xmllint, without the network; what it finds goes to stderr.
/// @param folder  Holds dcc.xsd and, by their names, all schemas that it imports.
/// @return whether the document satisfies the schema.
/// @throws InputError if there is no dcc.xsd; BenchError if xmllint cannot be run.
bool SatisfiesSchema(const std::string& document, const std::string& folder) {
  if (!std::filesystem::exists(folder + "/dcc.xsd"))
    throw InputError("--schema", folder + " holds no dcc.xsd", "a folder with dcc.xsd and the schemas that it imports");
  TemporaryFile file(document);
  constexpr int kDocumentWrong = 3, kDocumentUnsound = 4;  // xmllint(1)
  const int code = RunXmllint(folder, file.name());
  if (code != 0 && code != kDocumentWrong && code != kDocumentUnsound)
    throw InputError("--schema", fmt::format("xmllint could not read the schema (exit code {})", code),
                     "dcc.xsd and, beside it, all schemas that it imports");
  return code == 0;
}

using namespace certificate;

struct CertificateOptions {
  std::string run, laboratory, output = "-", schema;
  bool wants_template = false, force = false;
};

Temperature TemperatureOf(const std::vector<Reading>& readings, const Laboratory& laboratory, const std::string& laboratory_file) {
  if (std::isfinite(laboratory.temperature_degC))
    return {laboratory.temperature_degC, laboratory.expanded_temperature_degC, "as the laboratory states it"};
  double sum = 0.0, lowest = INFINITY, highest = -INFINITY;
  int count = 0;
  for (const Reading& reading : readings) {
    if (!std::isfinite(reading.temperature_degC)) continue;
    sum += reading.temperature_degC, ++count;
    lowest = std::min(lowest, reading.temperature_degC), highest = std::max(highest, reading.temperature_degC);
  }
  if (count == 0)
    throw InputError(laboratory_file, "there is no temperature, and the readings have none", "conditions.temperature_degC and its uncertainty");
  const double expanded_degC = std::isfinite(laboratory.expanded_temperature_degC) ? laboratory.expanded_temperature_degC : 0.0;
  return {sum / count, expanded_degC,
          fmt::format("mean of {} readings, {:.3f} to {:.3f} degC{}", count, lowest, highest,
                      expanded_degC > 0.0 ? "; uncertainty as the laboratory states it" : "; no uncertainty is stated")};
}

/// The twin by itself, and the twin shown as a bench, which says that it is one.
bool IsSimulated(const twinbench::Provenance& provenance, const Laboratory& laboratory) {
  const std::string& from = provenance.source;
  return laboratory.simulated || from == "twin" || from.find("simulated") != std::string::npos || from.find("twinbench") != std::string::npos;
}

void RequireTraceability(const CertificateContent& content, const std::string& laboratory_file) {
  if (!content.simulated && content.laboratory.traceability.empty())
    throw InputError(laboratory_file, "there is no traceability.statement", "to which standards the results are traceable");
}

Certified CertifiedOf(const RunFolder& folder, const nlohmann::json& results, const CertifiedBench& bench) {
  Certified certified = TakeCertified(results, bench);
  if (!certified.quantities.empty()) return certified;
  std::string why;
  if (!certified.left_out.empty()) why = ": " + certified.left_out.front().what + ", " + certified.left_out.front().why;
  throw InputError(folder.results(), "nothing in it can be certified" + why, "separable results with uncertainties");
}

CertificateContent ContentOf(const std::string& run, const std::string& laboratory, const std::string& laboratory_file) {
  const RunFolder folder{run};
  CertificateContent content;
  content.laboratory = ReadLaboratory(laboratory, laboratory_file);
  const auto record = RunRecord::Open(folder.path);
  if (!record->finished()) throw InputError(folder.record(), "the run is not finished", "a complete run");
  const twinbench::Provenance provenance = record->provenance();
  const CertifiedBench& bench = benches::CertifiedPartsOf(provenance.bench, folder.path);
  const nlohmann::json results = ReadJson(folder.results());
  content.certified = CertifiedOf(folder, results, bench);
  if (results.contains("diagnosis")) content.diagnosis = report::VerdictOf(results.at("diagnosis")).text;
  content.method = bench.method;
  content.run = std::filesystem::weakly_canonical(folder.path).filename().string();
  content.scenario_title = LoadScenario(folder.scenario()).title;
  content.readings_from = provenance.source, content.recorded_by = provenance.program_version;
  content.program_version = TWINBENCH_VERSION;
  content.simulated = IsSimulated(provenance, content.laboratory);
  content.temperature = TemperatureOf(record->Readings(), content.laboratory, laboratory_file);
  for (const std::string& file : {folder.results(), folder.scenario(), folder.record()})
    content.digests.emplace_back(std::filesystem::path(file).filename().string(), Sha256(BytesOfFile(file)));
  RequireTraceability(content, laboratory_file);
  return content;
}

void Write(const std::string& path, const std::string& text, const std::string& what) {
  if (path == "-") {
    fmt::print("{}", text);
    return;
  }
  WriteFileAtOnce(path, text);
  fmt::print("{}: {}\n", path, what);
}

nlohmann::json ToldJson(const CertificateContent& content) {
  nlohmann::json json = {{"simulated", content.simulated}, {"certified", nlohmann::json::array()}, {"left_out", nlohmann::json::array()}, {"issued", content.laboratory.issued}};
  for (const CertifiedQuantity& one : content.certified.quantities)
    json["certified"].push_back({{"title", one.title}, {"norm", one.norm}, {"values", one.values.size()}, {"unit", one.unit}, {"note", one.note}});
  for (const LeftOut& one : content.certified.left_out) json["left_out"].push_back({{"what", one.what}, {"why", one.why}});
  return json;
}

void RequireTwoPlaces(const CertificateOptions& options, const JsonAnswer& answer) {
  if (answer.IsOnStdout() && options.output == "-")
    throw InputError("certificate", "what is written and --json both go to stdout", "-o FILE, or --json FILE");
}

void MakeTemplate(const CertificateOptions& options, JsonAnswer& answer) {
  RequireFree(options.output, {}, options.force);
  Write(options.output, LaboratoryTemplate(), "fill in what is empty, then --with " + options.output);
  answer.Write({{"template", options.output}});
}

void MakeCertificate(const CertificateOptions& options, JsonAnswer& answer) {
  RequireTwoPlaces(options, answer);
  if (options.wants_template) return MakeTemplate(options, answer);
  if (options.run.empty()) throw InputError("certificate", "there is no run", "the folder of a run, or --template");
  if (options.laboratory.empty())
    throw InputError("certificate", "nothing is known of the laboratory", "--with laboratory.toml; --template writes one to fill in");
  const std::vector<std::string> inputs = {options.laboratory, RunFolder{options.run}.results(), RunFolder{options.run}.scenario()};
  RequireOutput(answer.to(), inputs);
  RequireFree(options.output, inputs, options.force);
  const std::string laboratory = InputText(options.laboratory, "what new --laboratory writes");
  Answer made = CertificateOf(options.run, laboratory, options.laboratory);
  if (!options.schema.empty() && !SatisfiesSchema(made.text, options.schema))
    throw InputError(options.output, "the certificate does not satisfy " + options.schema + "/dcc.xsd; nothing was written", "what xmllint says above");
  const std::size_t left_out = made.json.at("left_out").size();
  Write(options.output, made.text,
        fmt::format("{} results certified{}{}{}", made.json.at("certified").size(), left_out ? fmt::format(", {} left out and named", left_out) : "",
                    made.json.at("simulated").get<bool>() ? "; SIMULATED, which it says" : "",
                    made.json.at("issued") == "" ? "; no day of issue, which ISO/IEC 17025 asks for: certificate.issued" : ""));
  made.json["certificate"] = options.output;
  answer.Write(made.json);
}

}  // namespace

Answer CertificateOf(const std::string& run, const std::string& laboratory, const std::string& laboratory_file) {
  const CertificateContent content = ContentOf(run, laboratory, laboratory_file);
  return {ToldJson(content), CertificateXml(content)};
}

void AddCertificate(CLI::App& app) {
  auto* command = app.add_subcommand("certificate", "Write a run's results as a digital calibration certificate (DCC 3.3.0, XML)");
  auto options = std::make_shared<CertificateOptions>();
  command->add_option("run", options->run, "folder of a run that is finished");
  command->add_option("--with", options->laboratory, "TOML file of the laboratory, its customer and the item");
  AddTextOutput(*command, options->output, "the certificate")->capture_default_str();
  command->add_option("--schema", options->schema, "folder with dcc.xsd and the schemas that it imports: validate with xmllint first, and write nothing if it fails");
  command->add_flag("--template", options->wants_template, "write the TOML file to fill in instead");
  AddForce(*command, options->force);
  AnswerWith(*command, "what was certified and what was left out", [options](JsonAnswer& answer) { MakeCertificate(*options, answer); });
}

}  // namespace twinbench::tools
