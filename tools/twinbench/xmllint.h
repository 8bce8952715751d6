#pragma once

#include <string>

namespace twinbench::tools {

/// Validates a document with xmllint, without the network; what it finds goes to stderr.
/// @param folder  Holds dcc.xsd and, by their names, all schemas that it imports.
/// @return whether the document satisfies the schema.
/// @throws InputError if there is no dcc.xsd; BenchError if xmllint cannot be run.
bool SatisfiesSchema(const std::string& document, const std::string& folder);

}  // namespace twinbench::tools
