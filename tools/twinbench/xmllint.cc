#include "tools/twinbench/xmllint.h"

#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "twin/core/errors.h"

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

}  // namespace

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

}  // namespace twinbench::tools
